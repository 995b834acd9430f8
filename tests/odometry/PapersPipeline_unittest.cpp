// SPDX-License-Identifier: BSD-3-Clause
// What only the paper's configuration does between frames.
#include <pointplane/core/se3.h>

#include <limits>

#include "hell_frames.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::CachedSequence;
using test::CheckedOdometry;

/** As config-paper.ini, as far as it matters here. */
OdometryParams paper()
{
    OdometryParams out;
    out.pipeline.degeneracy = "gate";
    out.pipeline.searchAround = "previous";
    out.pipeline.gateSigma = 0.5;
    out.shutter.correct = false;
    out.points.method = "match";
    out.reference.reference = "adjacent";
    out.reference.keyframeMinOverlap = 0;
    out.covariance.model = "independent";
    out.poseSolver.covariance = "hessian";
    return out;
}

RgbdFrame withoutDepth(int i)
{
    RgbdFrame frame = CachedSequence::corner().frame(i);
    frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
    return frame;
}
}  // namespace

TEST(PapersPipeline, tracks)
{
    CheckedOdometry odometry(paper());
    const OdometryResult last = odometry.run(0, 6);
    EXPECT_EQ(last.status, TrackingStatus::Tracked) << last.reason;
    EXPECT_THAT(
        last.pose.mean,
        test::IsNearPose(CachedSequence::corner().sequence().trueMotion(0, 6), 0.03, 0.03));
}

/** [P17, section Pose estimation]: fewer than three matches, or the largest eigenvalue. */
TEST(PapersPipeline, theLargestEigenvalueGates)
{
    OdometryParams params = paper();
    CheckedOdometry measured(params);
    (void)measured.run(0, 1);
    const OdometryResult result = measured.run(2, 2);
    ASSERT_EQ(result.status, TrackingStatus::Tracked);
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(result.increment.cov);
    const double sigma = std::sqrt(es.eigenvalues().maxCoeff());
    params.pipeline.gateSigma = 0.9 * sigma;
    EXPECT_THAT(CheckedOdometry(params).run(0, 2).reason, testing::HasSubstr("above gateSigma"));
}

/** Other tests of the default configuration are not the paper's. */
TEST(PapersPipeline, nothingElseGates)
{
    OdometryParams params = paper();
    params.pipeline.leastAgreement = 0.99;
    EXPECT_EQ(CheckedOdometry(params).run(0, 2).status, TrackingStatus::Tracked);
}

TEST(PapersPipeline, fewerThanThreeMatchesAreNotSolvedFor)
{
    CheckedOdometry odometry(paper());
    (void)odometry.run(0, 2);
    const OdometryResult result = odometry.process(withoutDepth(3));
    EXPECT_EQ(result.status, TrackingStatus::Predicted);
    EXPECT_THAT(result.reason, testing::HasSubstr("found again: 0"));
    EXPECT_EQ(result.diagnostics.iterations, 0);
}

/** The frame before is the reference, whatever became of it: nothing is found in one without depth,
 * and the frame after that is tracked against its neighbour. */
TEST(PapersPipeline, framesAreComparedWithTheOneBefore)
{
    CheckedOdometry odometry(paper());
    (void)odometry.run(0, 3);
    EXPECT_EQ(odometry.process(withoutDepth(4)).status, TrackingStatus::Predicted);
    EXPECT_EQ(odometry.run(5, 5).status, TrackingStatus::Predicted);
    EXPECT_EQ(odometry.run(6, 6).status, TrackingStatus::Tracked);

    OdometryParams latestTracked = paper();
    latestTracked.reference.reference = "previous";
    CheckedOdometry other(latestTracked);
    (void)other.run(0, 3);
    EXPECT_EQ(other.process(withoutDepth(4)).status, TrackingStatus::Predicted);
    EXPECT_EQ(other.run(5, 5).status, TrackingStatus::Tracked);
}

/** What the source tells of its shutter makes no difference. */
TEST(PapersPipeline, imagesAreThoseOfOneInstant)
{
    CheckedOdometry told(paper()), untold(paper());
    for (int i = 0; i < 4; ++i)
    {
        RgbdFrame frame = CachedSequence::corner().frame(i);
        frame.shutter = {0.03, 0.03, 0.01};
        const OdometryResult a = told.process(frame);
        frame.shutter = {};
        const OdometryResult b = untold.process(frame);
        EXPECT_EQ(a.pose.mean.matrix(), b.pose.mean.matrix());
    }
}

/** Of points that move by more than the circle's radius, those are found that a prediction leads
 * to. */
TEST(PapersPipeline, featuresAreLookedForWhereTheyWere)
{
    const auto numPairs = [](const char* searchAround)
    {
        OdometryParams params = paper();
        params.pipeline.searchAround = searchAround;
        params.pointMatcher.searchRadiusPx = 4;
        CheckedOdometry odometry(params);
        OdometryResult last;
        for (int i = 0; i <= 16; i += 2)
        {
            last = odometry.run(i, i);
        }
        return last.diagnostics.numPointPairs;
    };
    EXPECT_GT(numPairs("prediction"), 5);
    EXPECT_EQ(numPairs("previous"), 0);
}
}  // namespace pointplane
