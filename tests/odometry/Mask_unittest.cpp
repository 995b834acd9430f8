// SPDX-License-Identifier: BSD-3-Clause
/** A camera that sees a part of the robot that carries it. */
#include <pointplane/odometry/Odometry.h>
#include <pointplane/odometry/robot_mask.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/imgproc.hpp>

#include <cmath>
#include <iostream>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kWidth = 320, kHeight = 240;

const SimulatedSequence& maskedDesk()
{
    static const SimulatedSequence sequence = []
    {
        SimulationParams params;
        params.width = kWidth;
        params.height = kHeight;
        params.duration = 1.5;
        return SimulatedSequence("desk", params, 1);
    }();
    return sequence;
}

/** 0 in the lowest third, where the robot is. */
cv::Mat robotMask()
{
    cv::Mat out(kHeight, kWidth, CV_8UC1, cv::Scalar(255));
    out.rowRange(2 * kHeight / 3, kHeight).setTo(0);
    return out;
}

/** The frame with a flat, patterned robot 0.4 m in front of the camera. */
RgbdFrame withRobot(RgbdFrame frame)
{
    cv::Mat pattern(kHeight, kWidth, CV_8UC1);
    cv::RNG random(3);
    random.fill(pattern, cv::RNG::UNIFORM, 20, 230);
    cv::GaussianBlur(pattern, pattern, {}, 2);
    cv::normalize(pattern, pattern, 20, 230, cv::NORM_MINMAX);
    const cv::Mat robot = robotMask() == 0;
    pattern.copyTo(frame.gray, robot);
    frame.depth.setTo(0.4, robot);
    return frame;
}

/** All frames, with the robot. */
const std::vector<RgbdFrame>& recording()
{
    static const std::vector<RgbdFrame> frames = []
    {
        std::vector<RgbdFrame> out;
        for (int i = 0; i < maskedDesk().numFrames(); ++i)
        {
            out.push_back(withRobot(maskedDesk().frame(i)));
        }
        return out;
    }();
    return frames;
}

/** \return how far the path's end is off [m] */
double errorOf(Odometry& odometry)
{
    OdometryResult last;
    for (const RgbdFrame& frame : recording())
    {
        last = odometry.process(frame);
        if (last.status != TrackingStatus::First && !odometry.mask().empty())
        {
            EXPECT_EQ(last.status, TrackingStatus::Tracked) << last.reason;
        }
    }
    const Eigen::Isometry3d truth = maskedDesk().trueMotion(0, maskedDesk().numFrames() - 1);
    return (last.pose.mean.translation() - truth.translation()).norm();
}
}  // namespace

TEST(Mask, leavesOutTheRobot)
{
    Odometry odometry{OdometryParams()};
    odometry.setMask(robotMask());
    const double masked = errorOf(odometry);
    for (const FrameFeatures::Point& point : odometry.features().points)
    {
        EXPECT_LT(point.uv_px.y(), 2 * kHeight / 3);
    }
    odometry.reset();
    EXPECT_EQ(errorOf(odometry), masked);  // reset() keeps the mask

    OdometryParams params;
    params.pipeline.findRobot = false;
    Odometry without{params};
    const double unmasked = errorOf(without);
    std::cout << 1e3 * masked << " mm, without the mask " << 1e3 * unmasked << " mm\n";
    EXPECT_LT(masked, 0.001);
    EXPECT_GT(unmasked, 2 * masked);
}

/** Until the robot is found it is the world; then it is as if there were a mask. */
TEST(Mask, withoutOneTheRobotIsFound)
{
    Odometry odometry{OdometryParams()};
    constexpr int kLater = 5;  // frames: poses come back to the world
    int foundAt = -1;
    Eigen::Isometry3d T_world_found = Eigen::Isometry3d::Identity(), T_world_last = T_world_found;
    for (int i = 0; i < maskedDesk().numFrames(); ++i)
    {
        const OdometryResult result = odometry.process(recording()[static_cast<size_t>(i)]);
        if (foundAt < 0 && result.diagnostics.attachedShare > 0)
        {
            foundAt = i;
            EXPECT_NEAR(result.diagnostics.attachedShare, 1.0 / 3, 0.05);
        }
        if (foundAt >= 0 && i == foundAt + kLater)
        {
            T_world_found = result.pose.mean;
        }
        T_world_last = result.pose.mean;
    }
    ASSERT_GE(foundAt, 0);
    EXPECT_LT(foundAt, maskedDesk().numFrames() / 2);
    const Eigen::Isometry3d motion = T_world_found.inverse() * T_world_last;
    const Eigen::Isometry3d truth =
        maskedDesk().trueMotion(foundAt + kLater, maskedDesk().numFrames() - 1);
    const double error = (motion.translation() - truth.translation()).norm();
    std::cout << "found in frame " << foundAt << " of " << maskedDesk().numFrames() << ", then "
              << 1e3 * error << " mm off\n";
    EXPECT_LT(error, 0.01);
}

TEST(Mask, doesNotChangeTheCallersImages)
{
    Odometry odometry{OdometryParams()};
    const cv::Mat mask = robotMask();
    odometry.setMask(mask);
    const RgbdFrame frame = recording()[0];
    (void)odometry.process(frame);
    EXPECT_EQ(frame.depth.at<float>(kHeight - 1, 0), 0.4F);
    EXPECT_NE(odometry.mask().data, mask.data);  // a copy
}

TEST(Mask, aFrozenImageIsStillToldFromANewOne)
{
    Odometry odometry{OdometryParams()};
    odometry.setMask(robotMask());
    RgbdFrame frame = recording()[0];
    (void)odometry.process(frame);
    frame.stamp += 1.0 / 30;
    EXPECT_THAT(odometry.process(frame).reason, testing::HasSubstr("byte for byte"));
}

/** The mask is of the colour image; depth images have no lens distortion. */
TEST(Mask, theDepthOfWhatItCoversIsLeftOut)
{
    PinholeCamera camera = maskedDesk().frame(0).camera;
    camera.distortion = {-0.3, 0.1, 0, 0, 0};
    const cv::Mat mask = maskOfDepth(robotMask(), camera);
    int differs = 0;
    for (int u = 0; u < kWidth; ++u)
    {
        for (int v = 0; v < kHeight; ++v)
        {
            const Eigen::Vector2d onDepth = camera.depthPixel({u, v});
            const cv::Point pixel(cvRound(onDepth.x()), cvRound(onDepth.y()));
            if (!cv::Rect({}, mask.size()).contains(pixel) || std::abs(v - 2 * kHeight / 3) <= 1)
            {
                continue;
            }
            EXPECT_EQ(mask.at<uchar>(pixel), robotMask().at<uchar>(v, u)) << u << " " << v;
            differs += robotMask().at<uchar>(pixel) != robotMask().at<uchar>(v, u) ? 1 : 0;
        }
    }
    EXPECT_GT(differs, 10);

    Odometry odometry{OdometryParams()};
    odometry.setMask(robotMask());
    RgbdFrame frame = recording()[0];
    frame.camera = camera;
    (void)odometry.process(frame);
    for (const FrameFeatures::Point& point : odometry.features().points)
    {
        EXPECT_LT(point.uv_px.y(), 2 * kHeight / 3);
    }
}

TEST(Mask, framesOfAnotherSizeAreLost)
{
    Odometry odometry{OdometryParams()};
    odometry.setMask(cv::Mat(cv::Mat::eye(120, 160, CV_8UC1)));
    const OdometryResult result = odometry.process(recording()[0]);
    EXPECT_EQ(result.status, TrackingStatus::Lost);
    EXPECT_EQ(result.reason, "the mask (160x120) is not of the images' size (320x240)");
    odometry.setMask({});
    EXPECT_EQ(odometry.process(recording()[1]).status, TrackingStatus::First);
}

TEST(Mask, darkerThanHalfOfTheBrightestIsTheRobot)
{
    for (const auto& [dark, bright] : {std::pair{0, 255}, {127, 255}, {0, 1}, {0, 2}, {4, 9}})
    {
        const cv::Mat mask(1, 2, CV_8UC1, cv::Scalar(bright));
        mask.col(0).setTo(dark);
        Odometry odometry{OdometryParams()};
        odometry.setMask(mask);
        EXPECT_EQ(odometry.mask().at<uchar>(0), 0) << dark << " of " << bright;
        EXPECT_EQ(odometry.mask().at<uchar>(1), 255) << dark << " of " << bright;
    }
}

TEST(Mask, whatIsNoMaskIsRefused)
{
    Odometry odometry{OdometryParams()};
    EXPECT_THROW(odometry.setMask(cv::Mat(kHeight, kWidth, CV_8UC3)), std::invalid_argument);
    const cv::Mat stack(std::vector<int>{4, 3, 2}, CV_8UC1, cv::Scalar(255));
    EXPECT_THROW(odometry.setMask(stack), std::invalid_argument);
    for (const int all : {0, 1, 255})
    {
        const cv::Mat mask(kHeight, kWidth, CV_8UC1, cv::Scalar(all));
        EXPECT_THROW(odometry.setMask(mask), std::invalid_argument) << all;
    }
    const cv::Mat nearlyWhite = robotMask() / 2 + 128;
    EXPECT_THROW(odometry.setMask(nearlyWhite), std::invalid_argument);
}

namespace
{
RgbdFrame withText(RgbdFrame frame)
{
    for (int line = 1; line <= 4; ++line)
    {
        const cv::Point place(10, line * kHeight / 5);
        cv::putText(
            frame.gray, "CAM 01 2024-03-02 REC", place, cv::FONT_HERSHEY_SIMPLEX, 0.8, 255, 2);
    }
    return frame;
}
}  // namespace

/** Each frame is compared with another one: nothing could ever settle the suspicion. */
TEST(Mask, textIsNotSoughtFromFrameToFrame)
{
    OdometryParams params;
    params.reference.reference = "adjacent";
    Odometry odometry(params);
    int numSuspected = 0;
    for (int i = 0; i < 12; ++i)
    {
        const OdometryResult result = odometry.process(withText(maskedDesk().frame(2 * i)));
        numSuspected += result.reason.find("stand in the image") != std::string::npos ? 1 : 0;
    }
    EXPECT_EQ(numSuspected, 0);
}

/** Where most corners are text that is drawn into the images, the camera seems to stand. */
TEST(Mask, textInTheImagesIsFound)
{
    SimulationParams simulation;
    simulation.width = kWidth;
    simulation.height = kHeight;
    simulation.duration = 1.5;
    simulation.motionSpeed = 2;
    const SimulatedSequence sequence("room", simulation, 2);
    Odometry odometry{OdometryParams()};
    int foundAt = sequence.numFrames();
    Eigen::Isometry3d T_world_found, T_world_last;
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        const OdometryResult result = odometry.process(withText(sequence.frame(i)));
        T_world_last = result.pose.mean;
        if (result.reason.find("fixed to the image, like text") != std::string::npos)
        {
            EXPECT_EQ(result.status, TrackingStatus::Predicted);
            foundAt = i;
            T_world_found = T_world_last;
        }
    }
    ASSERT_LT(foundAt, 10);
    const Eigen::Isometry3d truth = sequence.trueMotion(foundAt, sequence.numFrames() - 1);
    const Eigen::Isometry3d motion = T_world_found.inverse() * T_world_last;
    EXPECT_GT(truth.translation().norm(), 0.2);
    EXPECT_LT((motion.translation() - truth.translation()).norm(), 0.03);
}

/** A sensor that warms up, or whose first image is wrong. */
TEST(Mask, depthThatStaysChangedIsNoText)
{
    RgbdFrame frame = maskedDesk().frame(0);
    for (const int numWrong : {1, 4})
    {
        Odometry odometry{OdometryParams()};
        for (int i = 0; i < 9; ++i)
        {
            frame.stamp = maskedDesk().frame(i).stamp;
            frame.gray.at<std::uint8_t>(i, i) += 1;  // not the same bytes
            RgbdFrame seen = frame;
            seen.depth = cv::Mat(frame.depth * (i < numWrong ? 1.05 : 1 + 1e-5 * i));
            const OdometryResult result = odometry.process(seen);
            EXPECT_EQ(result.reason.find("in the image"), std::string::npos) << result.reason;
        }
    }
}

/** Depth of a camera that stands may be wrong for a frame, as that of time of flight is. */
TEST(Mask, depthThatJumpsOnceIsNoText)
{
    RgbdFrame frame = maskedDesk().frame(0);
    Odometry odometry{OdometryParams()};
    for (int i = 0; i < 9; ++i)
    {
        frame.stamp = maskedDesk().frame(i).stamp;
        frame.gray.at<std::uint8_t>(i, i) += 1;  // not the same bytes
        RgbdFrame seen = frame;
        seen.depth = cv::Mat(frame.depth * (i % 4 == 2 ? 1.1 : 1 + 1e-5 * i));
        const OdometryResult result = odometry.process(seen);
        const bool isMeasured = result.status == TrackingStatus::Tracked;
        EXPECT_EQ(isMeasured, i % 4 != 2 && i > 0) << i << ": " << result.reason;
        EXPECT_LT(result.pose.mean.translation().norm(), 1e-3);
    }
}
}  // namespace pointplane
