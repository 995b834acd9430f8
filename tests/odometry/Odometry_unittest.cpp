// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "hell_frames.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::CachedSequence;
using test::CheckedOdometry;

RgbdFrame frameOfCorner(int i) { return CachedSequence::corner().frame(i); }

const SimulatedSequence& truth() { return CachedSequence::corner().sequence(); }

RgbdFrame withoutAnything(RgbdFrame frame)
{
    frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
    frame.gray.setTo(0);
    return frame;
}

/** Poses, covariances and statuses of a run as bytes. */
std::string fingerprint(const OdometryParams& params, int numFrames)
{
    Odometry odometry(params);
    std::string out;
    const auto append = [&out](const auto& matrix)
    {
        out.append(
            reinterpret_cast<const char*>(matrix.data()),
            static_cast<size_t>(matrix.size()) * sizeof(double));
    };
    for (int i = 0; i < numFrames; ++i)
    {
        const OdometryResult r = odometry.process(frameOfCorner(i));
        append(r.pose.mean.matrix());
        append(r.pose.cov);
        append(r.increment.mean.matrix());
        append(r.increment.cov);
        out += toString(r.status) + r.reason;
    }
    return out;
}
}  // namespace

TEST(Odometry, beginsAtTheIdentity)
{
    CheckedOdometry odometry;
    const OdometryResult r = odometry.process(frameOfCorner(0));
    EXPECT_EQ(r.status, TrackingStatus::First);
    EXPECT_TRUE(r.reason.empty());
    EXPECT_EQ(r.stamp, frameOfCorner(0).stamp);
    EXPECT_TRUE(r.increment.mean.isApprox(Eigen::Isometry3d::Identity()));
    EXPECT_TRUE(r.pose.mean.isApprox(Eigen::Isometry3d::Identity()));
    EXPECT_LT(r.pose.cov.trace(), 1e-10);
}

TEST(Odometry, showsEachPointOnceAndWhatBecameOfIt)
{
    CheckedOdometry odometry;
    for (int i = 0; i <= 20; ++i)
    {
        const OdometryResult r = odometry.process(frameOfCorner(i));
        const FrameFeatures& shown = odometry.odometry().features();
        EXPECT_EQ(r.diagnostics.numPoints, static_cast<int>(shown.points.size()));
        int used = 0, found = 0;
        for (const FrameFeatures::Point& a : shown.points)
        {
            used += a.use == FeatureUse::Used ? 1 : 0;
            found += a.use == FeatureUse::New ? 0 : 1;
            for (const FrameFeatures::Point& b : shown.points)
            {
                ASSERT_TRUE(&a == &b || (a.uv_px - b.uv_px).norm() >= 3);
            }
        }
        EXPECT_LE(used, r.diagnostics.numPointInliers);
        EXPECT_LE(found, r.diagnostics.numPointPairs);
        EXPECT_TRUE(shown.isKeyframe || i > 0);
        EXPECT_EQ(shown.planeUses.size(), shown.planes.planes.size());
        if (i > 0)
        {
            ASSERT_EQ(r.status, TrackingStatus::Tracked);
            EXPECT_GT(used, 20);
            EXPECT_THAT(shown.planeUses, testing::Contains(FeatureUse::Used));
        }
    }
}

TEST(Odometry, showsNothingAsUsedInAFrameThatIsNotTracked)
{
    OdometryParams params;
    params.pipeline.degeneracy = "gate";
    params.pipeline.gateSigma = 1e-6;  // no estimate is as certain as that
    CheckedOdometry odometry(params);
    (void)odometry.process(frameOfCorner(0));
    ASSERT_EQ(odometry.process(frameOfCorner(1)).status, TrackingStatus::Predicted);
    int rejected = 0;
    for (const FrameFeatures::Point& point : odometry.odometry().features().points)
    {
        EXPECT_NE(point.use, FeatureUse::Used);
        rejected += point.use == FeatureUse::Rejected ? 1 : 0;
    }
    EXPECT_GT(rejected, 20);
}

TEST(Odometry, followsTheCornerWithEitherFeature)
{
    for (const bool points : {true, false})
    {
        for (const bool planes : {true, false})
        {
            if (!points && !planes)
            {
                continue;
            }
            SCOPED_TRACE(testing::Message() << "points " << points << " planes " << planes);
            OdometryParams params;
            params.pipeline.usePoints = points;
            params.pipeline.usePlanes = planes;
            CheckedOdometry odometry(params);
            for (int i = 0; i <= 20; ++i)
            {
                const OdometryResult r = odometry.process(frameOfCorner(i));
                EXPECT_EQ(r.status, i == 0 ? TrackingStatus::First : TrackingStatus::Tracked);
                EXPECT_EQ(r.diagnostics.numPointPairs > 20, points && i > 0);
                EXPECT_EQ(r.diagnostics.numPlanePairs > 2, planes && i > 0);
                EXPECT_EQ(r.diagnostics.observableDirections, i == 0 ? 0 : 6);
                EXPECT_GT(r.diagnostics.msTotal, 0);
                EXPECT_THAT(r.pose.mean, test::IsNearPose(truth().trueMotion(0, i), 0.01, 0.02));
            }
            EXPECT_EQ(odometry.odometry().features().planes.planes.empty(), !planes);
            EXPECT_EQ(odometry.odometry().features().points.empty(), !points);
        }
    }
}

TEST(Odometry, frameToFrameAndByDescriptors)
{
    OdometryParams frameToFrame;
    frameToFrame.reference.reference = "previous";
    OdometryParams descriptors = frameToFrame;
    descriptors.points.method = "match";
    descriptors.pointDetector.detector = "fast";
    descriptors.pipeline.degeneracy = "gate";
    for (const OdometryParams& params : {frameToFrame, descriptors})
    {
        CheckedOdometry odometry(params);
        const OdometryResult r = odometry.run(0, 10);
        EXPECT_EQ(r.status, TrackingStatus::Tracked);
        EXPECT_EQ(r.diagnostics.numReferences, 1);
        EXPECT_THAT(r.pose.mean, test::IsNearPose(truth().trueMotion(0, 10), 0.02, 0.03));
    }
}

TEST(Odometry, sameBitsTwiceAndWithTwoThreads)
{
    OdometryParams match;
    match.points.method = "match";
    match.pointDetector.detector = "fast";
    OdometryParams ransac;
    ransac.planeExtractor.ransac = true;
    ransac.planeExtractor.fitWeights = "sigmaZ";
    for (OdometryParams params : {OdometryParams{}, match, ransac})
    {
        const std::string one = fingerprint(params, 8);
        EXPECT_EQ(fingerprint(params, 8), one);
        params.pipeline.numThreads = 2;
        EXPECT_EQ(fingerprint(params, 8), one);
    }
}

TEST(Odometry, doesNotModifyOrKeepTheImages)
{
    Odometry a, b;
    for (int i = 0; i < 4; ++i)
    {
        const RgbdFrame frame = frameOfCorner(i);
        const OdometryResult expected = a.process(frame);
        RgbdFrame mine = frameOfCorner(i);
        const OdometryResult r = b.process(mine);
        EXPECT_EQ(cv::norm(mine.gray, frame.gray), 0);
        EXPECT_EQ(std::memcmp(mine.depth.data, frame.depth.data, 4 * frame.depth.total()), 0);
        mine.gray.setTo(0);
        mine.depth.setTo(0);
        EXPECT_EQ(r.pose.mean.matrix(), expected.pose.mean.matrix());
    }
}

TEST(Odometry, incrementsComposeToPosesAcrossGaps)
{
    CheckedOdometry odometry;
    Eigen::Isometry3d composed = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 14; ++i)
    {
        const bool bad = i == 5 || i == 8 || i == 9;
        const OdometryResult r =
            odometry.process(bad ? withoutAnything(frameOfCorner(i)) : frameOfCorner(i));
        composed = composed * r.increment.mean;
        EXPECT_THAT(r.pose.mean, test::IsNearPose(composed, 1e-9, 1e-9)) << i;
    }
}

TEST(Odometry, tellsMotionsSinceEarlierFrames)
{
    OdometryParams params;
    params.covariance.history = 6;
    CheckedOdometry odometry(params);
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < 14; ++i)
    {
        const bool bad = i == 5 || i == 8 || i == 9;
        const OdometryResult r =
            odometry.process(bad ? withoutAnything(frameOfCorner(i)) : frameOfCorner(i));
        poses.push_back(r.pose.mean);
        ASSERT_EQ(r.since.size(), static_cast<size_t>(std::min(i, 6)));
        for (size_t n = 1; n <= r.since.size(); ++n)
        {
            const PoseGaussian& motion = r.since[n - 1];
            const Eigen::Isometry3d composed = poses[poses.size() - 1 - n].inverse() * poses.back();
            EXPECT_THAT(motion.mean, test::IsNearPose(composed, 1e-9, 1e-9)) << i << " " << n;
            EXPECT_TRUE(isPositiveDefinite(motion.cov)) << i << " " << n;
        }
        if (i > 0)
        {
            EXPECT_TRUE(r.since[0].cov.isApprox(r.increment.cov, 1e-6)) << i;
        }
    }
}

/** Compared with the same key frames, frames have errors of their own, which do not add up; what
 * the key frames err by, seen from elsewhere, comes on top. */
TEST(Odometry, errorsAgainstKeyFramesDoNotAddUp)
{
    struct Variances
    {
        double ofOne, ofTen;
    };
    const auto overFrames = [](const std::string& model, double drift)
    {
        OdometryParams params;
        params.covariance.history = 10;
        params.covariance.model = model;
        params.covariance.viewNoise *= std::sqrt(drift);
        CheckedOdometry odometry(params);
        (void)odometry.run(0, 10);
        Variances sum{0, 0};  // some frames are noisier than others
        for (int i = 10; i < 20; ++i)
        {
            const OdometryResult r = odometry.run(i, i + 1);
            sum.ofOne += r.since[0].cov.trace();
            sum.ofTen += r.since.back().cov.trace();
        }
        return sum;
    };
    const Variances still = overFrames("joint", 0), drifting = overFrames("joint", 1),
                    fast = overFrames("joint", 5), independent = overFrames("independent", 0);
    EXPECT_GT(drifting.ofTen, still.ofTen);
    EXPECT_NEAR(fast.ofTen - still.ofTen, 5 * (drifting.ofTen - still.ofTen), 0.01 * fast.ofTen);
    EXPECT_GT(drifting.ofTen / drifting.ofOne, still.ofTen / still.ofOne);
    EXPECT_GT(independent.ofTen / independent.ofOne, 3 * still.ofTen / still.ofOne);
}

/** After a gap the increment leads on from a predicted pose, whose error it has to undo. */
TEST(Odometry, incrementsAcrossGapsAreHonest)
{
    double afterGap = 0, predicted = 0;
    int numGaps = 0;
    CheckedOdometry odometry;
    for (int i = 0; i < 60; ++i)
    {
        const bool bad = i > 0 && i % 5 >= 3;
        const OdometryResult r =
            odometry.process(bad ? withoutAnything(frameOfCorner(i)) : frameOfCorner(i));
        const Eigen::Isometry3d increment = i > 0 ? truth().trueMotion(i - 1, i) : r.increment.mean;
        const double error = test::normalisedError(increment, r.increment);
        if (bad)
        {
            EXPECT_EQ(r.status, TrackingStatus::Predicted);
            predicted += error * error;
        }
        else if (i > 0 && i % 5 == 0)
        {
            EXPECT_EQ(r.status, TrackingStatus::Tracked);
            afterGap += error * error;
            ++numGaps;
        }
    }
    // Mean NEES per direction: 1 when right; a pessimistic motion model gives less.
    EXPECT_LT(afterGap / numGaps, 2);
    EXPECT_LT(predicted / (2 * numGaps), 2);
}

TEST(Odometry, oneWallIsFusedOrGated)
{
    OdometryParams gate;
    gate.pipeline.degeneracy = "gate";
    for (const OdometryParams& params : {OdometryParams{}, gate})
    {
        CheckedOdometry odometry(params);
        for (int i = 0; i < 5; ++i)
        {
            RgbdFrame frame = frameOfCorner(i);
            frame.gray.setTo(128);
            frame.depth.setTo(1.5 - 0.01 * i);  // approached by 1 cm a frame
            frame.shutter = {0, 0, 0};          // all rows at once
            const OdometryResult r = odometry.process(frame);
            const bool fuses = params.pipeline.degeneracy == "fuse";
            if (i == 0)
            {
                continue;
            }
            EXPECT_EQ(r.status, fuses ? TrackingStatus::Tracked : TrackingStatus::Predicted);
            EXPECT_FALSE(r.reason.empty());
            if (fuses)
            {
                EXPECT_NEAR(r.pose.mean.translation().z(), 0.01 * i, 0.004);
                EXPECT_LT(std::abs(r.pose.mean.translation().x()), 1e-3);
            }
        }
    }
}

TEST(Odometry, statusesHaveNames)
{
    EXPECT_STREQ(toString(TrackingStatus::First), "first");
    EXPECT_STREQ(toString(TrackingStatus::Tracked), "tracked");
    EXPECT_STREQ(toString(TrackingStatus::Predicted), "predicted");
    EXPECT_STREQ(toString(TrackingStatus::Lost), "lost");
}

TEST(Odometry, refusesParametersNamingSectionAndKey)
{
    const auto message = [](auto change)
    {
        OdometryParams params;
        change(params);
        try
        {
            const Odometry odometry(params);
        }
        catch (const std::invalid_argument& error)
        {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    const auto expectNamed = [](const std::string& text, const char* section, const char* key)
    {
        EXPECT_THAT(text, testing::HasSubstr(section));
        EXPECT_THAT(text, testing::HasSubstr(key));
    };
    expectNamed(
        message([](auto& p) { p.pipeline.usePoints = p.pipeline.usePlanes = false; }),
        "[Pipeline]",
        "usePoints");
    expectNamed(
        message([](auto& p) { p.pipeline.degeneracy = "hope"; }), "[Pipeline]", "degeneracy");
    expectNamed(message([](auto& p) { p.pipeline.gateSigma = 0; }), "[Pipeline]", "gateSigma");
    expectNamed(
        message([](auto& p) { p.pipeline.leastAgreement = 1; }), "[Pipeline]", "leastAgreement");
    expectNamed(message([](auto& p) { p.pipeline.maxGap = -1; }), "[Pipeline]", "maxGap");
    expectNamed(message([](auto& p) { p.pipeline.numThreads = 3; }), "[Pipeline]", "numThreads");
    expectNamed(message([](auto& p) { p.shutter.readoutDepth = 2; }), "[Shutter]", "readoutDepth");
    expectNamed(
        message([](auto& p) { p.planeExtractor.cellSizePx = 1; }),
        "[PlaneExtractor]",
        "cellSizePx");
    expectNamed(message([](auto& p) { p.poseSolver.alpha = -1; }), "[PoseSolver]", "alpha");
}
}  // namespace pointplane
