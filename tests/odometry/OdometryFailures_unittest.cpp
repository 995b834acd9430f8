// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <utility>
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

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr int kBad = 4;  //!< number of the frame that is tampered with

RgbdFrame good(int i) { return CachedSequence::corner().frame(i); }

/** Frames 0-3 are good, 4 is given, 5-7 are good: what happened at 4, 5 and 7. */
struct Outcome
{
    explicit Outcome(const RgbdFrame& bad, const OdometryParams& params = {}) : odometry(params)
    {
        EXPECT_EQ(odometry.run(0, kBad - 1).status, TrackingStatus::Tracked);
        at = odometry.process(bad);
        next = odometry.run(kBad + 1, kBad + 1);
        last = odometry.run(kBad + 2, kBad + 3);
    }
    CheckedOdometry odometry;
    OdometryResult at, next, last;
};

/** The pose of frame 7 is as if nothing had happened. */
void expectRecovered(const Outcome& outcome)
{
    EXPECT_EQ(outcome.next.status, TrackingStatus::Tracked) << outcome.next.reason;
    EXPECT_EQ(outcome.last.status, TrackingStatus::Tracked) << outcome.last.reason;
    const auto& sequence = CachedSequence::corner().sequence();
    EXPECT_THAT(
        outcome.last.pose.mean, test::IsNearPose(sequence.trueMotion(0, kBad + 3), 0.02, 0.03));
}

void expectLost(const RgbdFrame& bad, const char* reason)
{
    const Outcome outcome(bad);
    EXPECT_EQ(outcome.at.status, TrackingStatus::Lost);
    EXPECT_THAT(outcome.at.reason, testing::HasSubstr(reason));
    expectRecovered(outcome);
}

void expectPredicted(const RgbdFrame& bad)
{
    const Outcome outcome(bad);
    EXPECT_EQ(outcome.at.status, TrackingStatus::Predicted) << outcome.at.reason;
    expectRecovered(outcome);
}
}  // namespace

/** The points of the references have depth: the image alone tells the motion. */
TEST(OdometryFailures, allDepthMissing)
{
    RgbdFrame frame = good(kBad);
    for (const float none : {kNaN, 0.0F})
    {
        frame.depth.setTo(none);
        const Outcome outcome(frame);
        EXPECT_EQ(outcome.at.status, TrackingStatus::Tracked) << outcome.at.reason;
        EXPECT_THAT(
            outcome.at.pose.mean,
            test::IsNearPose(
                CachedSequence::corner().sequence().trueMotion(0, kBad), 0.005, 0.005));
        expectRecovered(outcome);
    }
}

TEST(OdometryFailures, oneValidPixel)
{
    RgbdFrame frame = good(kBad);
    frame.depth.setTo(kNaN);
    frame.depth.at<float>(120, 160) = 1.5F;
    const Outcome outcome(frame);
    EXPECT_EQ(outcome.at.status, TrackingStatus::Tracked) << outcome.at.reason;
    expectRecovered(outcome);
}

TEST(OdometryFailures, noDepthAndNoPoints)
{
    RgbdFrame frame = good(kBad);
    frame.depth.setTo(kNaN);
    OdometryParams params;
    params.pipeline.usePoints = false;
    EXPECT_EQ(Outcome(frame, params).at.status, TrackingStatus::Predicted);
}

/** Of the first frame's velocity nothing is known. */
TEST(OdometryFailures, theSecondFrameIsLost)
{
    CheckedOdometry odometry;  // compares the covariances of the motion
    EXPECT_EQ(odometry.process(good(0)).status, TrackingStatus::First);
    for (int i = 1; i < 4; ++i)
    {
        RgbdFrame frame = good(i);
        frame.depth.release();
        EXPECT_EQ(odometry.process(frame).status, TrackingStatus::Lost);
    }
}

/** Then the velocity is unknown, also to the joint covariance. */
TEST(OdometryFailures, blindForLongerThanMaxGap)
{
    OdometryParams params;
    params.pipeline.usePoints = false;
    CheckedOdometry odometry(params);  // compares the covariances of the motion
    EXPECT_EQ(odometry.run(0, 3).status, TrackingStatus::Tracked);
    OdometryResult result;
    for (int i = 4; i < 4 + 45; ++i)
    {
        RgbdFrame frame = good(4);
        frame.stamp = good(3).stamp + (i - 3) / 30.0;
        frame.depth.setTo(kNaN);
        frame.gray.at<std::uint8_t>(0, 0) = static_cast<std::uint8_t>(i);  // not frozen
        result = odometry.process(frame);
        EXPECT_EQ(result.status, TrackingStatus::Predicted);
    }
    EXPECT_GT(std::sqrt(result.pose.cov(0, 0)), 0.1) << "half a second at an unknown velocity";
}

TEST(OdometryFailures, sequenceThatBeginsWithoutDepth)
{
    CheckedOdometry odometry;
    for (int i = 0; i < 3; ++i)
    {
        RgbdFrame frame = good(i);
        frame.depth.setTo(kNaN);
        const OdometryResult result = odometry.process(frame);
        EXPECT_EQ(result.status, TrackingStatus::Lost);
        EXPECT_EQ(
            result.reason, "its depth image has no reading; a path cannot begin without depth");
        EXPECT_GT(result.pose.cov(0, 0), 1e-5) << "nobody knows where that was";
    }
    // The path begins here. How the camera came here is not known.
    const OdometryResult first = odometry.process(good(3));
    EXPECT_EQ(first.status, TrackingStatus::First);
    EXPECT_LT(first.pose.cov.diagonal().maxCoeff(), 1e-10);
    EXPECT_GT(first.increment.cov(0, 0), 1e-5);
    EXPECT_EQ(odometry.process(good(4)).status, TrackingStatus::Tracked);
    EXPECT_EQ(odometry.process(good(5)).status, TrackingStatus::Tracked);
}

/** A frame that no path could begin with was not used: its images are not repeated by the next. */
TEST(OdometryFailures, theFirstGoodFrameMayHaveTheColourOfTheOneBefore)
{
    CheckedOdometry odometry;
    RgbdFrame blind = good(0);
    blind.depth.setTo(kNaN);
    blind.stamp -= 1.0 / 30;
    EXPECT_EQ(odometry.process(blind).status, TrackingStatus::Lost);
    const OdometryResult first = odometry.process(good(0));
    EXPECT_EQ(first.status, TrackingStatus::First);
    EXPECT_EQ(first.reason, "");
    EXPECT_GT(odometry.process(good(1)).diagnostics.numPointPairs, 50);
}

/** Not 33 ms, whatever the time is: the camera may go far in 2 s. */
TEST(OdometryFailures, motionsBeforeTheFirstGoodFrameTakeTheTimeOfTheirStamps)
{
    const auto sigmasAt = [](double interval)
    {
        CheckedOdometry odometry;
        std::vector<double> out;
        for (int i = 0; i < 4; ++i)
        {
            RgbdFrame frame = good(i);
            frame.stamp = 1e9 + i * interval;
            if (i < 3)
            {
                frame.depth.setTo(kNaN);
            }
            out.push_back(std::sqrt(odometry.process(frame).increment.cov(0, 0)));
        }
        return out;
    };
    const std::vector<double> usual = sigmasAt(1.0 / 30), slow = sigmasAt(2);
    EXPECT_EQ(slow[0], usual[0]) << "nothing was before it";
    for (const std::size_t i : {1U, 2U, 3U})
    {
        EXPECT_GT(slow[i], 10 * usual[i]) << i;
    }
}

/** In the first frame, and later where there is nothing else. */
TEST(OdometryFailures, itIsToldWhyThereIsNoDepth)
{
    const auto noDepth = [](cv::Mat& depth) { depth.setTo(kNaN); };
    const auto infinite = [](cv::Mat& depth) { depth.setTo(kInf); };
    const auto sparse = [](cv::Mat& depth)
    {
        depth.setTo(kNaN);
        depth.row(10).setTo(1);  // of 240
    };
    const auto millimetres = [](cv::Mat& depth) { depth *= 1000; };
    const auto kilometres = [](cv::Mat& depth) { depth *= 0.001; };
    const auto both = [](cv::Mat& depth)
    {
        depth.setTo(0.001);
        depth.rowRange(0, 60).setTo(200);
    };
    const std::vector<std::pair<std::function<void(cv::Mat&)>, std::string>> cases{
        {noDepth, "its depth image has no reading"},
        {infinite, "its depth image has no reading"},
        {sparse, "its depth image has readings in only 0.42 % of its pixels"},
        {millimetres, "% of its depth pixels are farther than PointLifter.maxDepth (100 m)"},
        {kilometres, "% of its depth pixels are nearer than PointLifter.minDepth (0.02 m)"},
        {both, "75 % of its depth pixels are nearer than PointLifter.minDepth (0.02 m)"}};
    for (const auto& [change, reason] : cases)
    {
        RgbdFrame frame = good(0);
        change(frame.depth);
        const OdometryResult first = CheckedOdometry().process(frame);
        EXPECT_EQ(first.status, TrackingStatus::Lost);
        EXPECT_THAT(
            first.reason, testing::EndsWith(reason + "; a path cannot begin without depth"));

        frame = good(kBad);
        change(frame.depth);
        frame.gray.setTo(0);
        const OdometryResult later = Outcome(frame).at;
        EXPECT_EQ(later.status, TrackingStatus::Predicted);
        EXPECT_THAT(
            later.reason,
            testing::StartsWith("too few points and planes are found again: 0; "
                                "no point is found in its colour image (mean grey 0 of 255, "
                                "standard deviation 0); "));
        EXPECT_THAT(later.reason, testing::EndsWith(reason));
    }
}

TEST(OdometryFailures, itIsToldWhyThereIsNoPoint)
{
    for (const char* method : {"track", "match"})
    {
        OdometryParams params;
        params.points.method = method;
        params.pipeline.usePlanes = false;
        const auto reasonOf = [&](const std::function<void(cv::Mat&)>& change)
        {
            RgbdFrame frame = good(kBad);
            change(frame.gray);
            const OdometryResult result = Outcome(frame, params).at;
            EXPECT_EQ(result.status, TrackingStatus::Predicted) << result.reason;
            return result.reason;
        };
        // As of a sensor: the noise that it adds is no texture.
        const auto shine = [](double mean)
        {
            return [mean](cv::Mat& gray)
            {
                cv::RNG random(1);
                random.fill(gray, cv::RNG::NORMAL, mean, 1);
            };
        };
        const std::string few = "too few points and planes are found again: 0; ";
        const std::string noPoint = few + "no point is found in its colour image (mean grey ";
        if (params.points.tracks())
        {
            EXPECT_EQ(reasonOf(shine(2)), noPoint + "2 of 255, standard deviation 1)");
            EXPECT_EQ(reasonOf(shine(120)), noPoint + "120 of 255, standard deviation 1)");
            // A lamp beside a white wall.
            const auto shade = [](cv::Mat& gray)
            {
                for (int u = 0; u < gray.cols; ++u)
                {
                    gray.col(u).setTo(80 + 120 * u / gray.cols);
                }
            };
            EXPECT_EQ(reasonOf(shade), noPoint + "139 of 255, standard deviation 35)");
        }
        EXPECT_EQ(
            reasonOf([](cv::Mat& gray) { gray.setTo(255); }),
            noPoint + "255 of 255, standard deviation 0)");
        EXPECT_EQ(reasonOf([](cv::Mat& gray) { gray.release(); }), few + "it has no colour image");
    }
}

/** A camera in the dark, or with a hand before its depth camera, is tracked for a while. */
TEST(OdometryFailures, aTrackedFrameTellsWhatItLacks)
{
    RgbdFrame noDepth = good(kBad), black = good(kBad), noColour = good(kBad);
    noDepth.depth.setTo(kNaN);
    black.gray.setTo(0);
    noColour.gray.release();
    for (const auto& [frame, reason] :
         {std::pair(noDepth, "its depth image has no reading"),
          std::pair(black, "(mean grey 0 of 255, standard deviation 0)"),
          std::pair(noColour, "it has no colour image")})
    {
        const OdometryResult result = Outcome(frame).at;
        EXPECT_EQ(result.status, TrackingStatus::Tracked) << reason;
        EXPECT_THAT(result.reason, testing::EndsWith(reason));
    }
    black = good(0);
    black.gray.setTo(0);
    const OdometryResult first = CheckedOdometry().process(black);
    EXPECT_EQ(first.status, TrackingStatus::First);
    EXPECT_THAT(first.reason, testing::StartsWith("no point is found in its colour image"));
    EXPECT_EQ(Outcome(good(kBad)).at.reason, "");
}

TEST(OdometryFailures, aMaskThatLeavesNoDepthIsTold)
{
    Odometry odometry;
    const RgbdFrame frame = good(0);
    cv::Mat mask(frame.depth.size(), CV_8UC1, cv::Scalar(0));
    mask.at<std::uint8_t>(0, 0) = 255;
    odometry.setMask(mask);
    EXPECT_EQ(
        odometry.process(frame).reason,
        "nearly all of its depth is of the robot itself; a path cannot begin without depth");
}

TEST(OdometryFailures, depthThatIsNoiseIsNone)
{
    CheckedOdometry odometry;
    cv::RNG random(1);
    for (int i = 0; i < 4; ++i)
    {
        RgbdFrame frame = good(i);
        random.fill(frame.depth, cv::RNG::UNIFORM, 0.5, 5);
        const OdometryResult result = odometry.process(frame);
        EXPECT_EQ(result.status, TrackingStatus::Lost);
        EXPECT_THAT(result.reason, testing::HasSubstr("its depth image is noise"));
    }
}

TEST(OdometryFailures, aStreamThatHangsCountsAsMissing)
{
    for (const bool colourHangs : {true, false})
    {
        CheckedOdometry odometry;
        for (int i = 0; i < 12; ++i)
        {
            SCOPED_TRACE(testing::Message() << "frame " << i << (colourHangs ? " colour" : ""));
            RgbdFrame frame = good(i);
            const bool hangs = i > 4;
            const RgbdFrame old = good(std::min(i, 4));
            (colourHangs ? frame.gray : frame.depth) = colourHangs ? old.gray : old.depth;
            const OdometryResult result = odometry.process(frame);
            EXPECT_EQ(
                result.reason.find("image is that of the frame before") != std::string::npos, hangs)
                << result.reason;
            const Eigen::Isometry3d truth = CachedSequence::corner().sequence().trueMotion(0, i);
            const Vector6d error = se3Log(truth.inverse() * result.pose.mean);
            EXPECT_LT(error.dot(result.pose.cov.ldlt().solve(error)), 40);
        }
    }
}

/** Two exposures cannot be a microsecond apart, whatever the stamps say. */
TEST(OdometryFailures, aStampHardlyLaterThanTheOneBeforeTellsNoSpeed)
{
    double sigma[2] = {0, 0};
    for (const bool isClose : {false, true})
    {
        CheckedOdometry odometry;
        for (int i = 0; i < 12; ++i)
        {
            RgbdFrame frame = good(i);
            if (isClose && i == 6)
            {
                frame = good(5);
                frame.depth.at<float>(0, 0) = 1.5F;  // not frozen
                frame.gray.at<std::uint8_t>(0, 0) ^= 1;
                frame.stamp += 1e-6;
            }
            sigma[isClose] = odometry.process(frame).diagnostics.maxSigmaTranslation;
        }
    }
    EXPECT_LT(sigma[1], 2 * sigma[0]);
}

TEST(OdometryFailures, everythingOnePlane)
{
    // A wall without texture: three directions are seen, the others are the motion model's.
    CheckedOdometry odometry;
    for (int i = 0; i < 6; ++i)
    {
        RgbdFrame frame = good(i);
        frame.gray.setTo(128);
        frame.depth.setTo(1.5);
        frame.depth.row(0).setTo(1.5 + 1e-6 * i);  // not frozen
        frame.shutter = {0, 0, 0};  // of a rolling one, the unknown velocity would reach z
        const OdometryResult result = odometry.process(frame);
        EXPECT_EQ(result.diagnostics.numPlanes, 1);
        if (i > 0)
        {
            EXPECT_EQ(result.status, TrackingStatus::Tracked);
            EXPECT_EQ(result.diagnostics.observableDirections, 3);
            EXPECT_FALSE(result.reason.empty());
            // Along z it knows, along x and y it says that it does not.
            EXPECT_LT(result.increment.cov(2, 2), 0.01 * result.increment.cov(0, 0));
            EXPECT_GT(result.increment.cov(0, 0), 1e-6);
        }
    }
}

TEST(OdometryFailures, everythingAtTenMetres)
{
    RgbdFrame frame = good(kBad);
    frame.depth.setTo(10);
    Outcome outcome(frame);
    EXPECT_NE(outcome.at.status, TrackingStatus::Lost);
    expectRecovered(outcome);
}

TEST(OdometryFailures, unusableIntrinsics)
{
    for (const double value : {static_cast<double>(kNaN), kInf, -kInf, 0.0})
    {
        RgbdFrame frame = good(kBad);
        frame.camera.fx = value;
        expectLost(frame, "fx");
        frame = good(kBad);
        frame.camera.fy = value;
        expectLost(frame, "fy");
    }
    RgbdFrame frame = good(kBad);
    frame.camera.cx = kNaN;
    expectLost(frame, "cx");
    frame = good(kBad);
    frame.camera.distortion[1] = kNaN;
    expectLost(frame, "not finite");
    frame = good(kBad);
    frame.camera.width = 0;
    expectLost(frame, "empty");
}

TEST(OdometryFailures, imagesThatDoNotFitTheCamera)
{
    RgbdFrame frame = good(kBad);
    frame.depth = frame.depth.colRange(0, 100).clone();
    expectLost(frame, "depth image (100x240)");
    frame.depth = cv::Mat();
    expectLost(frame, "there is no depth image");
    frame = good(kBad);
    frame.depth.convertTo(frame.depth, CV_64FC1);
    expectLost(frame, "depth image is not CV_32FC1");
    frame = good(kBad);
    frame.gray = frame.gray.rowRange(0, 100).clone();
    expectLost(frame, "intensity image (320x100)");
    const int sizes[] = {240, 320, 2};
    frame = good(kBad);
    frame.gray = cv::Mat(3, sizes, CV_8UC1, cv::Scalar(90));
    expectLost(frame, "intensity image is not CV_8UC1");
    frame.depth = cv::Mat(3, sizes, CV_32FC1, cv::Scalar(1));
    expectLost(frame, "depth image is not CV_32FC1");
}

TEST(OdometryFailures, blackAndSaturatedImagesLeaveThePlanes)
{
    for (const int grey : {0, 255})
    {
        RgbdFrame frame = good(kBad);
        frame.gray.setTo(grey);
        const Outcome outcome(frame);
        EXPECT_EQ(outcome.at.status, TrackingStatus::Tracked) << outcome.at.reason;
        EXPECT_EQ(outcome.at.diagnostics.numPointPairs, 0);
        EXPECT_EQ(outcome.at.diagnostics.numPlanePairs > 2, true);
        expectRecovered(outcome);
    }
}

/** A key frame of the dark has no points. One of the light takes its place, however little moved.
 */
TEST(OdometryFailures, aPathThatBeginsInTheDarkHasPointsAsSoonAsThereIsLight)
{
    for (const double light : {0.0, 0.02})
    {
        RgbdFrame dark = good(0);
        dark.gray = light > 0 ? cv::Mat(light * dark.gray) : cv::Mat();
        CheckedOdometry odometry;
        EXPECT_EQ(odometry.process(dark).status, TrackingStatus::First);
        EXPECT_EQ(odometry.run(1, 1).diagnostics.numPointInliers, 0);
        EXPECT_GT(odometry.run(2, 2).diagnostics.numPointInliers, 50) << light;
    }
}

TEST(OdometryFailures, allPointsAreBackWithTheFirstColourImage)
{
    CheckedOdometry odometry;
    const int before = odometry.run(0, 3).diagnostics.numPointInliers;
    for (int i = 4; i < 9; ++i)
    {
        RgbdFrame frame = good(i);
        frame.gray = cv::Mat();
        EXPECT_EQ(odometry.process(frame).diagnostics.numPointInliers, 0);
    }
    EXPECT_GT(odometry.run(9, 9).diagnostics.numPointInliers, 0.6 * before);
}

TEST(OdometryFailures, noIntensityImageLeavesThePlanes)
{
    RgbdFrame frame = good(kBad);
    frame.gray = cv::Mat();
    const Outcome outcome(frame);
    EXPECT_EQ(outcome.at.status, TrackingStatus::Tracked) << outcome.at.reason;
    expectRecovered(outcome);
}

TEST(OdometryFailures, neitherDepthNorImage)
{
    RgbdFrame frame = good(kBad);
    frame.gray.setTo(0);
    frame.depth.setTo(kNaN);
    expectPredicted(frame);
}

TEST(OdometryFailures, framesThatHardlyDifferDoNotMove)
{
    CheckedOdometry odometry;
    RgbdFrame frame = good(0);
    (void)odometry.process(frame);
    for (int i = 1; i < 5; ++i)
    {
        frame.stamp += 1.0 / 30;
        frame.gray.row(0).setTo(i);  // not frozen
        const OdometryResult result = odometry.process(frame);
        EXPECT_EQ(result.status, TrackingStatus::Tracked);
        EXPECT_THAT(result.pose.mean, test::IsNearPose(Eigen::Isometry3d::Identity(), 1e-4, 1e-4));
    }
}

/** The camera is suddenly 2 m away, in a view that shares nothing with the last one. */
TEST(OdometryFailures, jumpOfTwoMetres)
{
    CachedSequence desk("desk");
    for (const bool sameScene : {true, false})
    {
        CheckedOdometry odometry;
        (void)odometry.run(0, 3);
        RgbdFrame frames[5];
        for (int i = 0; i < 5; ++i)
        {
            frames[i] = sameScene ? good(300 + i) : desk.frame(100 + i);
            frames[i].stamp = good(4 + i).stamp;
        }
        const OdometryResult jumped = odometry.process(frames[0]);
        EXPECT_EQ(jumped.status, TrackingStatus::Predicted) << "not what three points say";
        (void)odometry.process(frames[1]);
        OdometryResult result;
        for (int i = 2; i < 5; ++i)
        {
            result = odometry.process(frames[i]);
            EXPECT_EQ(result.status, TrackingStatus::Tracked) << i << ": " << result.reason;
        }
        const auto& sequence = sameScene ? CachedSequence::corner().sequence() : desk.sequence();
        const int last = sameScene ? 304 : 104;
        EXPECT_THAT(
            result.increment.mean,
            test::IsNearPose(sequence.trueMotion(last - 1, last), 0.01, 0.02));
    }
}

TEST(OdometryFailures, equalAndSlightlyBackwardStamps)
{
    RgbdFrame frame = good(kBad);
    frame.stamp = good(kBad - 1).stamp;
    expectLost(frame, "time stamp");
    frame.stamp = good(kBad - 2).stamp;
    expectLost(frame, "time stamp");
    frame.stamp = static_cast<double>(kNaN);
    expectLost(frame, "time stamp");
    frame.stamp = kInf;
    expectLost(frame, "time stamp");
}

TEST(OdometryFailures, shuttersThatNoCameraHas)
{
    for (const double time : {1.5, -1e300, kInf})
    {
        RgbdFrame frame = good(kBad);
        frame.shutter.readoutColour = time;
        expectLost(frame, "shutter");
        frame.shutter = {0.02, 0.02, time};
        expectLost(frame, "shutter");
    }
}

/** What was unknown meanwhile must not drown what is measured after it. */
TEST(OdometryFailures, motionsAfterDaysAreAsCertainAsBefore)
{
    CheckedOdometry odometry;
    const Matrix6d before = odometry.run(0, 3).increment.cov;
    for (int i = 4; i < 8; ++i)
    {
        RgbdFrame frame = good(i);
        frame.stamp += 1e6;
        frame.depth = i == 4 ? cv::Mat(frame.depth.size(), CV_32FC1, kNaN) : frame.depth;
        frame.gray = i == 4 ? cv::Mat::zeros(frame.gray.size(), CV_8UC1) : frame.gray;
        const OdometryResult result = odometry.process(frame);
        if (i > 5)
        {
            EXPECT_EQ(result.status, TrackingStatus::Tracked);
            EXPECT_LT(result.increment.cov.trace(), 10 * before.trace()) << i;
        }
    }
}

/** A frame of an earlier time is not where the camera will be next, and does not move it on. */
TEST(OdometryFailures, aLateFrameLeavesTheCameraWhereItIs)
{
    RgbdFrame blank = good(kBad + 1);
    blank.depth = cv::Mat(blank.depth.size(), CV_32FC1, kNaN);
    blank.gray = cv::Mat::zeros(blank.gray.size(), CV_8UC1);
    CheckedOdometry plain, late;
    (void)plain.run(0, kBad - 1);
    (void)late.run(0, kBad - 1);
    for (const double stamp : {good(kBad - 3).stamp, static_cast<double>(kNaN)})
    {
        RgbdFrame frame = good(kBad);
        frame.stamp = stamp;
        const OdometryResult result = late.process(frame);
        EXPECT_EQ(result.status, TrackingStatus::Lost);
        EXPECT_TRUE(result.increment.mean.isApprox(Eigen::Isometry3d::Identity()));
        if (std::isfinite(stamp))
        {
            const Vector6d way =
                se3Log(CachedSequence::corner().sequence().trueMotion(kBad - 1, kBad - 3));
            EXPECT_LT(way.dot(result.increment.cov.ldlt().solve(way)), 9);
        }
    }
    const OdometryResult expected = plain.process(blank), found = late.process(blank);
    EXPECT_EQ(found.status, TrackingStatus::Predicted);
    EXPECT_TRUE(found.increment.mean.isApprox(expected.increment.mean, 1e-9));
    EXPECT_TRUE(found.increment.cov.isApprox(expected.increment.cov, 1e-6));
}

TEST(OdometryFailures, clockSetBackByAnHour)
{
    CheckedOdometry odometry;
    (void)odometry.run(0, 3);
    OdometryResult result;
    for (int i = 4; i < 10; ++i)
    {
        RgbdFrame frame = good(i);
        frame.stamp -= 3600;
        result = odometry.process(frame);
        EXPECT_EQ(result.status, i == 4 ? TrackingStatus::Lost : TrackingStatus::Tracked)
            << result.reason;
        const bool isKnown = std::sqrt(result.pose.cov.topLeftCorner<3, 3>().trace()) < 0.01;
        EXPECT_EQ(isKnown, i != 4)
            << "it may be anywhere, until it is compared with the references";
    }
    EXPECT_THAT(
        result.increment.mean,
        test::IsNearPose(CachedSequence::corner().sequence().trueMotion(8, 9), 0.01, 0.01));
}

/** Elsewhere, when the clock runs again: what was seen before says nothing of the motion. */
TEST(OdometryFailures, elsewhereAfterTheClockWasSetBack)
{
    CheckedOdometry odometry;
    (void)odometry.run(0, 3);
    CachedSequence& elsewhere = CachedSequence::desk();
    for (int i = 0; i < 4; ++i)
    {
        RgbdFrame frame = elsewhere.frame(i);
        frame.camera = good(0).camera;
        frame.stamp -= 3600;
        const OdometryResult result = odometry.process(frame);
        EXPECT_GT(std::sqrt(result.pose.cov.topLeftCorner<3, 3>().trace()), 1) << i;
    }
}

/** Of a usable frame, and of one that is lost. */
TEST(OdometryFailures, oneStampHoursAhead)
{
    for (const bool isUsable : {true, false})
    {
        CheckedOdometry odometry;
        (void)odometry.run(0, 3);
        RgbdFrame frame = good(4);
        frame.stamp += 5 * 3600;
        frame.depth = isUsable ? frame.depth : cv::Mat();
        (void)odometry.process(frame);
        const OdometryResult result = odometry.run(5, 10);
        EXPECT_EQ(result.status, TrackingStatus::Tracked) << result.reason;
        EXPECT_LT(std::sqrt(result.pose.cov.topLeftCorner<3, 3>().trace()), 0.01);
    }
}

TEST(OdometryFailures, hoursApart)
{
    CheckedOdometry odometry;
    (void)odometry.run(0, 3);
    OdometryResult result;
    for (int i = 4; i < 8; ++i)
    {
        RgbdFrame frame = good(i);
        frame.stamp += 7 * 3600;
        result = odometry.process(frame);
        EXPECT_EQ(result.status, TrackingStatus::Tracked) << result.reason;
    }
    EXPECT_THAT(
        result.pose.mean,
        test::IsNearPose(CachedSequence::corner().sequence().trueMotion(0, 7), 0.02, 0.03));
}

/** The motion model must not carry a walking pace through the night. */
TEST(OdometryFailures, badFrameHoursLater)
{
    CheckedOdometry odometry;
    (void)odometry.run(0, 3);
    RgbdFrame frame = good(4);
    frame.stamp += 7 * 3600;
    frame.depth.setTo(kNaN);
    frame.gray.setTo(0);
    const OdometryResult bad = odometry.process(frame);
    EXPECT_EQ(bad.status, TrackingStatus::Predicted);
    EXPECT_LT(bad.increment.mean.translation().norm(), 1);
    for (int i = 5; i < 8; ++i)
    {
        frame = good(i);
        frame.stamp += 7 * 3600;
        EXPECT_EQ(odometry.process(frame).status, TrackingStatus::Tracked);
    }
}

/** Milli-, micro- and nanoseconds since 1970, and what a damaged file may have. */
TEST(OdometryFailures, stampsThatAreNoSeconds)
{
    RgbdFrame frame = good(kBad);
    for (const double stamp : {1305031102175.0, 1.3e15, 1.3e18, -1.3e18, 1e300})
    {
        frame.stamp = stamp;
        expectLost(frame, "is too large for seconds; divide milliseconds by 1e3");
    }
}

/** What follows from stamps that are far away is finite. */
TEST(OdometryFailures, stampsOfAnotherCentury)
{
    for (const double stamp : {1e9, 1e10})
    {
        CheckedOdometry odometry;
        (void)odometry.run(0, 3);
        for (int i = 4; i < 7; ++i)
        {
            RgbdFrame bad = good(i);
            bad.stamp = stamp * i;
            bad.depth.setTo(kNaN);
            bad.gray.setTo(0);
            EXPECT_EQ(odometry.process(bad).status, TrackingStatus::Predicted) << stamp;
        }
        RgbdFrame back = good(7);
        back.stamp = stamp * 7;
        EXPECT_EQ(odometry.process(back).status, TrackingStatus::Tracked) << stamp;
    }
}

TEST(OdometryFailures, nothingButBadFrames)
{
    CheckedOdometry odometry;
    for (int i = 0; i < 5; ++i)
    {
        RgbdFrame frame = good(i);
        frame.camera.fx = static_cast<double>(kNaN);
        EXPECT_EQ(odometry.process(frame).status, TrackingStatus::Lost);
    }
    EXPECT_EQ(odometry.run(5, 5).status, TrackingStatus::First);
    EXPECT_EQ(odometry.run(6, 7).status, TrackingStatus::Tracked);
}

TEST(OdometryFailures, resolutionChangesInTheMiddle)
{
    CachedSequence other("corner", 160, 120);
    CheckedOdometry odometry;
    (void)odometry.run(0, 3);
    const OdometryResult changed = odometry.process(other.frame(4));
    EXPECT_EQ(changed.status, TrackingStatus::Predicted);
    EXPECT_THAT(changed.reason, testing::HasSubstr("camera"));
    EXPECT_EQ(odometry.process(other.frame(5)).status, TrackingStatus::Tracked);
    EXPECT_EQ(odometry.process(other.frame(6)).status, TrackingStatus::Tracked);
    EXPECT_EQ(odometry.run(7, 7).status, TrackingStatus::Predicted);
    const OdometryResult last = odometry.run(8, 10);
    EXPECT_EQ(last.status, TrackingStatus::Tracked);
    EXPECT_LT(
        test::normalisedError(CachedSequence::corner().sequence().trueMotion(0, 10), last.pose), 3);
}

TEST(OdometryFailures, intrinsicsChangeInTheMiddle)
{
    CheckedOdometry odometry;
    (void)odometry.run(0, 3);
    for (int i = 4; i < 8; ++i)
    {
        RgbdFrame frame = good(i);
        frame.camera.fx += 5;
        frame.camera.distortion[0] = 0.01;
        EXPECT_EQ(
            odometry.process(frame).status,
            i == 4 ? TrackingStatus::Predicted : TrackingStatus::Tracked);
    }
}

/** What was learnt of one camera's depth is not said of the next one. */
TEST(OdometryFailures, anotherCamerasDepthNoiseIsLearntAnew)
{
    CheckedOdometry odometry;
    std::string flat, real;
    for (int i = 0; i < 6; ++i)
    {
        RgbdFrame frame = good(i);
        for (int v = 0; v < frame.depth.rows; ++v)
        {
            frame.depth.row(v).setTo(2 + 1e-3 * v);
        }
        flat = odometry.process(frame).diagnostics.depthNoise.kind;
    }
    EXPECT_EQ(flat, "rendered");
    for (int i = 6; i < 9; ++i)
    {
        RgbdFrame frame = good(i);
        frame.camera.fx += 1;
        real = odometry.process(frame).diagnostics.depthNoise.kind;
    }
    EXPECT_EQ(real, "structuredLight");
}

TEST(OdometryFailures, imagesOfAnySize)
{
    const std::vector<cv::Size> sizes{
        {1, 1}, {2, 3}, {8, 8}, {9, 1}, {17, 16}, {33, 21}, {4096, 3072}};
    for (const cv::Size& size : sizes)
    {
        for (const char* method : {"track", "match"})
        {
            if (size.width > 1000 && std::string(method) == "match")
            {
                continue;  // a second of SURF
            }
            SCOPED_TRACE(testing::Message() << size.width << "x" << size.height << " " << method);
            OdometryParams params;
            params.points.method = method;
            CheckedOdometry odometry(params);
            RgbdFrame frame;
            frame.camera.width = size.width;
            frame.camera.height = size.height;
            frame.camera.fx = frame.camera.fy = 0.8 * size.width;
            frame.camera.cx = 0.5 * size.width;
            frame.camera.cy = 0.5 * size.height;
            frame.depth = cv::Mat(size, CV_32FC1, cv::Scalar(2));
            frame.gray = cv::Mat(size, CV_8UC1, cv::Scalar(100));
            for (int i = 0; i < 3; ++i)
            {
                frame.stamp = 100 + i / 30.0;
                EXPECT_NE(odometry.process(frame).status, TrackingStatus::Lost);
            }
            if (size.width < 1000)
            {
                RgbdFrame next = good(0);
                next.stamp = 101;
                (void)odometry.process(next);
                next.stamp = 101.03;
                next.gray.row(0).setTo(0);  // not frozen
                next.depth.at<float>(0, 0) = 1.5F;
                EXPECT_EQ(odometry.process(next).status, TrackingStatus::Tracked);
            }
        }
    }
}

TEST(OdometryFailures, nonsenseInThePixels)
{
    RgbdFrame frame = good(kBad);
    const float values[] = {
        kNaN, static_cast<float>(kInf), static_cast<float>(-kInf), -1.F, 0.F, 1e-38F, 1e38F, 1e-3F};
    int k = 0;
    for (int v = 0; v < frame.depth.rows; ++v)
    {
        for (int u = v % 3; u < frame.depth.cols; u += 3)
        {
            frame.depth.at<float>(v, u) = values[k++ % 8];
        }
    }
    expectRecovered(Outcome(frame));
}

TEST(OdometryFailures, resetForgets)
{
    Odometry odometry;
    (void)odometry.process(good(0));
    (void)odometry.process(good(1));
    odometry.reset();
    const OdometryResult first = odometry.process(good(0));
    EXPECT_EQ(first.status, TrackingStatus::First);
    EXPECT_TRUE(first.pose.mean.isApprox(Eigen::Isometry3d::Identity()));
}
}  // namespace pointplane
