// SPDX-License-Identifier: BSD-3-Clause
// What config-paper.ini does between frames.
#include <pointplane/core/se3.h>
#include <pointplane/mrpt_io/params_ini.h>

#include <limits>
#include <string>

#include "hell_frames.h"
#include "linear_algebra.h"
#include "uncertainty/MotionModel.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::CachedSequence;
using test::CheckedOdometry;

OdometryParams paper() { return loadOdometryParams(POINTPLANE_SOURCE_DIR "/config-paper.ini"); }

OdometryParams paperOfPlanesAlone()
{
    OdometryParams out = paper();
    out.pipeline.usePoints = false;
    return out;
}

RgbdFrame withoutDepth(int i)
{
    RgbdFrame frame = CachedSequence::corner().frame(i);
    frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
    return frame;
}

/** The corner's two walls: no depth near the floor, z = 0. */
RgbdFrame withoutFloor(int i)
{
    RgbdFrame frame = CachedSequence::corner().frame(i);
    const Eigen::Isometry3d T_world_cam = CachedSequence::corner().sequence().truth(frame.stamp);
    for (int v = 0; v < frame.depth.rows; ++v)
    {
        for (int u = 0; u < frame.depth.cols; ++u)
        {
            float& z = frame.depth.at<float>(v, u);
            const Eigen::Vector3d ray(
                (u - frame.camera.cx) / frame.camera.fx,
                (v - frame.camera.cy) / frame.camera.fy,
                1);
            if (!((T_world_cam * (static_cast<double>(z) * ray)).z() > 0.1))
            {
                z = std::numeric_limits<float>::quiet_NaN();
            }
        }
    }
    return frame;
}

/** Of the second of two frames. */
OdometryResult secondOf(const OdometryParams& params, RgbdFrame (*frame)(int))
{
    CheckedOdometry odometry(params);
    (void)odometry.process(frame(0));
    return odometry.process(frame(1));
}

RgbdFrame wholeFrame(int i) { return CachedSequence::corner().frame(i); }

Vector6d logOf(const OdometryResult& result) { return se3Log(result.increment.mean); }

/** What becomes of a velocity from frame to frame, before anything is learnt of it. */
DecayedVelocities decay() { return MotionModel({}).after(1.0 / 30); }

/** The motion that is predicted after a measured one. */
Vector6d oneFrameOn(const Vector6d& measured)
{
    return 30 * decay().reach().cwiseProduct(measured);
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

/** [P17, section Pose estimation]: H^-1 of the last estimate; a frame that it rejects moves on as
 * the one before. */
TEST(PapersPipeline, theLargestEigenvalueGates)
{
    OdometryParams params = paper();
    CheckedOdometry measured(params);
    const Vector6d before = logOf(measured.run(0, 1));
    const OdometryResult result = measured.run(2, 2);
    ASSERT_EQ(result.status, TrackingStatus::Tracked);
    const double sigma = std::sqrt(test::symmetricEigen(result.increment.cov).values.maxCoeff());
    params.pipeline.gateSigma = 1.001 * sigma;
    EXPECT_EQ(CheckedOdometry(params).run(0, 2).status, TrackingStatus::Tracked);
    params.pipeline.gateSigma = 0.999 * sigma;
    CheckedOdometry gated(params);
    (void)gated.run(0, 1);
    const OdometryResult rejected = gated.run(2, 2);
    EXPECT_THAT(rejected.reason, testing::HasSubstr("above gateSigma"));
    EXPECT_THAT(logOf(rejected), test::IsMatrixNear(oneFrameOn(before), 1e-6));
}

/** All is a fifth farther than in the frames before: the default configuration refuses that. */
TEST(PapersPipeline, nothingElseGates)
{
    const auto statusOfAnImpossibleFrame = [](const OdometryParams& params)
    {
        CheckedOdometry odometry(params);
        (void)odometry.run(0, 3);
        RgbdFrame frame = CachedSequence::corner().frame(4);
        frame.depth *= 1.2;
        return odometry.process(frame).status;
    };
    EXPECT_EQ(statusOfAnImpossibleFrame(paper()), TrackingStatus::Tracked);
    EXPECT_EQ(statusOfAnImpossibleFrame({}), TrackingStatus::Predicted);
}

/** Points and planes count as one each. */
TEST(PapersPipeline, fewerThanThreeMatchesAreNotSolvedFor)
{
    const OdometryResult none =
        secondOf(paper(), [](int i) { return i == 0 ? wholeFrame(i) : withoutDepth(i); });
    EXPECT_EQ(none.status, TrackingStatus::Predicted);
    EXPECT_THAT(none.reason, testing::HasSubstr("found again: 0"));
    EXPECT_EQ(none.diagnostics.iterations, 0);

    const OdometryResult two = secondOf(paperOfPlanesAlone(), withoutFloor);
    EXPECT_EQ(two.status, TrackingStatus::Predicted);
    EXPECT_THAT(two.reason, testing::HasSubstr("found again: 2"));
    EXPECT_EQ(two.diagnostics.iterations, 0);

    const OdometryResult three = secondOf(paperOfPlanesAlone(), wholeFrame);
    EXPECT_EQ(three.status, TrackingStatus::Tracked) << three.reason;
    EXPECT_EQ(three.diagnostics.numPlanePairs, 3);

    const OdometryResult both = secondOf(paper(), withoutFloor);
    EXPECT_EQ(both.status, TrackingStatus::Tracked) << both.reason;
    EXPECT_EQ(both.diagnostics.numPlanePairs, 2);
}

/** Each frame that is not measured moves on by less than the one before. */
TEST(PapersPipeline, theVelocityDecaysWhereNothingIsMeasured)
{
    CheckedOdometry odometry(paper());
    const OdometryResult last = odometry.run(0, 3);
    ASSERT_EQ(last.status, TrackingStatus::Tracked);
    Vector6d expected = oneFrameOn(logOf(last));
    ASSERT_GT(expected.norm(), 1e-3);
    for (int i = 4; i < 8; ++i)
    {
        EXPECT_THAT(logOf(odometry.process(withoutDepth(i))), test::IsMatrixNear(expected, 1e-6));
        expected = expected.cwiseProduct(decay().kept()).eval();
    }
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
