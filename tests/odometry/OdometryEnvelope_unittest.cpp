// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <string>

#include "hell_frames.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** A desk: what happens outside of smooth recordings at 30 Hz. */
class OdometryEnvelope : public testing::Test
{
 protected:
    static test::CachedSequence& desk()
    {
        static test::CachedSequence cached("desk");
        return cached;
    }

    /** The next frame; a tracked step must be near the truth. */
    OdometryResult process(int i) { return process(i, desk().frame(i)); }

    OdometryResult process(int i, const RgbdFrame& frame)
    {
        const OdometryResult result = odometry.process(frame);
        if (result.status == TrackingStatus::Tracked && last >= 0)
        {
            ++numTracked;
            EXPECT_THAT(
                result.increment.mean,
                test::IsNearPose(desk().sequence().trueMotion(last, i), 0.02, 0.02))
                << "frame " << i << " after " << last;
        }
        last = i;
        return result;
    }

    test::CheckedOdometry odometry;
    int last{-1};
    int numTracked{0};
};

TEST_F(OdometryEnvelope, threeImagesASecond)
{
    for (int i = 0; i <= 200; i += 10)
    {
        (void)process(i);
    }
    EXPECT_GE(numTracked, 19);
}

TEST_F(OdometryEnvelope, halfASecondMissing)
{
    for (int i = 0; i < 20; ++i)
    {
        (void)process(i);
    }
    for (int i = 35; i < 40; ++i)
    {
        EXPECT_EQ(process(i).status, TrackingStatus::Tracked);
    }
}

/** For two thirds of a second there is no depth. Points go on; frames without depth are no key
 * frames. */
TEST_F(OdometryEnvelope, depthIsMissingForTwentyFrames)
{
    int numKeyframes = 0;
    for (int i = 0; i < 45; ++i)
    {
        RgbdFrame frame = desk().frame(i);
        const bool isBlind = i >= 20 && i < 40;
        if (isBlind)
        {
            frame.depth = cv::Mat(frame.depth.size(), CV_32FC1, cv::Scalar(0));
        }
        const OdometryResult result = process(i, frame);
        EXPECT_EQ(result.status, i == 0 ? TrackingStatus::First : TrackingStatus::Tracked)
            << i << ": " << result.reason;
        if (i > 0)
        {
            EXPECT_LT(
                test::normalisedError(desk().sequence().trueMotion(i - 1, i), result.increment), 3)
                << i;
        }
        numKeyframes += isBlind && odometry.isKeyframe() ? 1 : 0;
    }
    EXPECT_EQ(numKeyframes, 0);
}

/** A few points on the folds of blank walls agree with a motion along them by chance. */
TEST(OdometryEnvelopeOfBlankWalls, fewPointsAfterAGapDoNotDecide)
{
    SimulationParams params;
    params.duration = 6;
    const SimulatedSequence walls("notexture", params, 7);
    test::CheckedOdometry odometry;
    for (int i = 24; i < 44; ++i)
    {
        (void)odometry.process(walls.frame(i));
    }
    const OdometryResult back = odometry.process(walls.frame(94));
    EXPECT_LT(test::normalisedError(walls.trueMotion(43, 94), back.increment), 3);
}

/** Planes alone, and nothing to see for two and a half seconds. */
class OdometryEnvelopeOfPlanes : public testing::Test
{
 protected:
    static OdometryResult back(const SimulatedSequence& sequence)
    {
        OdometryParams params;
        params.pipeline.usePoints = false;
        test::CheckedOdometry odometry(params);
        for (int i = 0; i <= kLast; ++i)
        {
            (void)odometry.process(sequence.frame(i));
        }
        return odometry.process(sequence.frame(kBack));
    }

    static SimulatedSequence sequence(const std::string& scene)
    {
        SimulationParams params;
        params.duration = 4;
        return {scene, params, 5};
    }

    static constexpr int kLast = 30, kBack = 110;
};

/** The camera has gone 0.9 m around a cabinet, and turned by 31 deg. */
TEST_F(OdometryEnvelopeOfPlanes, planesAreFoundAgainWithoutAPrediction)
{
    const SimulatedSequence cabinet = sequence("cabinet");
    const OdometryResult result = back(cabinet);
    const Eigen::Isometry3d truth = cabinet.trueMotion(kLast, kBack);
    EXPECT_GT(truth.translation().norm(), 0.5);
    EXPECT_EQ(result.status, TrackingStatus::Tracked) << result.reason;
    EXPECT_THAT(result.increment.mean, test::IsNearPose(truth, 0.01, 0.04));
    EXPECT_LT(test::normalisedError(truth, result.increment), 3);
}

/** Three turns lay the walls of a corner over each other. */
TEST_F(OdometryEnvelopeOfPlanes, whatFitsInSeveralWaysIsNotChosen)
{
    const SimulatedSequence corner = sequence("corner");
    const OdometryResult result = back(corner);
    EXPECT_EQ(result.status, TrackingStatus::Predicted);
    EXPECT_LT(test::normalisedError(corner.trueMotion(kLast, kBack), result.increment), 3);
}

TEST_F(OdometryEnvelope, blindForASecondAndBackInAKnownPlace)
{
    for (int i = 0; i < 20; ++i)
    {
        (void)process(i);
    }
    for (int i = 20; i < 50; ++i)
    {
        RgbdFrame frame = desk().frame(i);
        frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
        frame.gray.setTo(0);
        const OdometryResult blind = odometry.process(frame);
        EXPECT_EQ(blind.status, TrackingStatus::Predicted);
        EXPECT_GT(blind.diagnostics.maxSigmaTranslation, 0);
    }
    OdometryResult back;
    for (int i = 50; i < 53; ++i)
    {
        back = odometry.process(desk().frame(i));
    }
    EXPECT_EQ(back.status, TrackingStatus::Tracked) << back.reason;
    EXPECT_THAT(back.pose.mean, test::IsNearPose(desk().sequence().trueMotion(0, 52), 0.03, 0.03));
}

/** As of a stream that mixes up cameras. The images are told apart by the prediction alone. */
TEST(OdometryEnvelopeOfForeignFrames, twoOfThemDoNotHideTheKnownPlace)
{
    OdometryParams params;
    params.pipeline.searchImages = false;
    test::CheckedOdometry odometry(params);
    (void)odometry.run(0, 5);
    test::CachedSequence room("room");
    const RgbdFrame foreign[] = {test::CachedSequence::desk().frame(6), room.frame(7)};
    for (int i = 0; i < 2; ++i)
    {
        RgbdFrame frame = foreign[i];
        frame.stamp = test::CachedSequence::corner().frame(6 + i).stamp;
        EXPECT_EQ(odometry.process(frame).status, TrackingStatus::Predicted) << i;
    }
    const OdometryResult back = odometry.run(8, 8);
    EXPECT_EQ(back.status, TrackingStatus::Tracked) << back.reason;
    EXPECT_THAT(
        back.pose.mean,
        test::IsNearPose(test::CachedSequence::corner().sequence().trueMotion(0, 8), 0.005, 0.005));
}

TEST_F(OdometryEnvelope, frozenImagesAreSaid)
{
    for (int i = 0; i < 5; ++i)
    {
        (void)process(i);
    }
    RgbdFrame frozen = desk().frame(4);
    for (int i = 5; i < 9; ++i)
    {
        frozen.stamp = desk().frame(i).stamp;
        const OdometryResult result = odometry.process(frozen);
        EXPECT_EQ(result.status, TrackingStatus::Predicted);
        EXPECT_THAT(result.reason, testing::HasSubstr("byte for byte"));
        EXPECT_LT(
            test::normalisedError(desk().sequence().trueMotion(i - 1, i), result.increment), 3);
    }
    OdometryResult moving;
    for (int i = 9; i < 12; ++i)
    {
        moving = odometry.process(desk().frame(i));
    }
    EXPECT_EQ(moving.status, TrackingStatus::Tracked) << moving.reason;
    EXPECT_THAT(
        moving.pose.mean, test::IsNearPose(desk().sequence().trueMotion(0, 11), 0.01, 0.02));
}

TEST_F(OdometryEnvelope, oneByteThatDiffersIsNotFrozen)
{
    for (int i = 0; i < 5; ++i)
    {
        (void)process(i);
    }
    RgbdFrame frame = desk().frame(4);
    frame.stamp = desk().frame(5).stamp;
    frame.gray.at<uchar>(frame.gray.rows - 1, frame.gray.cols - 1) ^= 1;
    EXPECT_EQ(odometry.process(frame).status, TrackingStatus::Tracked);
}

/** The features would agree with a motion that the rest of the image contradicts. */
TEST_F(OdometryEnvelope, depthThatContradictsTheFeaturesIsNotTracked)
{
    for (int i = 0; i < 5; ++i)
    {
        (void)process(i);
    }
    RgbdFrame frame = desk().frame(5);
    frame.depth *= 1.3;  // as from a camera whose scale has changed
    const OdometryResult result = odometry.process(frame);
    EXPECT_EQ(result.status, TrackingStatus::Predicted);
    EXPECT_FALSE(result.reason.empty());
}

/** Some motion always lays a wall over the surfaces; it is far from the predicted one. */
TEST_F(OdometryEnvelope, oneForeignDepthImageIsNoMotion)
{
    for (int i = 22; i < 30; ++i)
    {
        (void)process(i);
    }
    RgbdFrame frame = desk().frame(30);
    frame.depth.setTo(2.0F);  // as from a wall
    const OdometryResult result = process(30, frame);
    EXPECT_EQ(result.status, TrackingStatus::Predicted);
    EXPECT_THAT(
        result.reason,
        testing::AnyOf(
            testing::HasSubstr("the depth image shows only 0 % of the surfaces"),
            testing::ContainsRegex(
                "standard deviations from the predicted one.*points in view [12]?[0-9] of "
                "[0-9]+,")))
        << "hardly any of them agrees";
    for (int i = 31; i < 35; ++i)
    {
        EXPECT_EQ(process(i).status, TrackingStatus::Tracked) << i;
    }
}
/** Their error becomes one of the pose, of which its covariance knows. */
TEST_F(OdometryEnvelope, nominalIntrinsicsArePoseErrors)
{
    const auto deviation = [](double focalLength, bool isNominal)
    {
        test::CheckedOdometry other;
        OdometryResult result;
        for (int i = 0; i < 60; ++i)
        {
            RgbdFrame frame = desk().frame(i);
            frame.camera.fx *= focalLength;
            frame.camera.fy *= focalLength;
            frame.camera.isNominal = isNominal;
            result = other.process(frame);
        }
        return test::normalisedError(desk().sequence().trueMotion(0, 59), result.pose);
    };
    const double ofCalibrated = deviation(1, false);
    EXPECT_GT(deviation(1.025, false), 4 * ofCalibrated) << "who does not know is sure, and wrong";
    EXPECT_LT(deviation(1.025, true), 1.2 * ofCalibrated);
    EXPECT_LT(deviation(0.975, true), 1.2 * ofCalibrated);
}
}  // namespace
}  // namespace pointplane
