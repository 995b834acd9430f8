// SPDX-License-Identifier: BSD-3-Clause
#include "frame_changes.h"

#include <opencv2/core.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

using namespace pointplane;

namespace
{
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/** A slanted plane, brightness and inverse depth linear in the pixel. */
RgbdFrame slantedPlane()
{
    RgbdFrame frame;
    frame.camera.width = 640;
    frame.camera.height = 480;
    frame.camera.fx = frame.camera.fy = 525;
    frame.camera.cx = 319.5;
    frame.camera.cy = 239.5;
    frame.gray = cv::Mat(480, 640, CV_8UC1);
    frame.depth = cv::Mat(480, 640, CV_32FC1);
    for (int v = 0; v < 480; ++v)
    {
        for (int u = 0; u < 640; ++u)
        {
            frame.gray.at<uchar>(v, u) = static_cast<uchar>(u / 4);
            frame.depth.at<float>(v, u) =
                1.0F / (0.5F + 2e-4F * static_cast<float>(u) + 1e-4F * static_cast<float>(v));
        }
    }
    return frame;
}

int numReadings(const cv::Mat& depth) { return cv::countNonZero(depth == depth); }
}  // namespace

TEST(FrameChanges, AMirrorSwapsLeftAndRight)
{
    const RgbdFrame frame = slantedPlane();
    const RgbdFrame seen = mirrored(frame);
    EXPECT_EQ(seen.gray.at<uchar>(7, 0), frame.gray.at<uchar>(7, 639));
    EXPECT_EQ(seen.depth.at<float>(7, 600), frame.depth.at<float>(7, 39));
    EXPECT_EQ(frame.gray.at<uchar>(7, 0), 0) << "the given frame is as it was";
}

TEST(FrameChanges, TakeAwayWhatTheySayAndLeaveTheirInputAlone)
{
    const RgbdFrame frame = slantedPlane();
    EXPECT_TRUE(showsSomething(frame));

    const RgbdFrame noDepth = withoutDepth(frame);
    EXPECT_EQ(numReadings(noDepth.depth), 0);
    EXPECT_EQ(noDepth.depth.size(), frame.depth.size());
    EXPECT_FALSE(showsSomething(noDepth));

    const RgbdFrame noColour = withoutColour(frame);
    EXPECT_EQ(cv::countNonZero(noColour.gray), 0);
    EXPECT_EQ(numReadings(noColour.depth), 640 * 480);
    EXPECT_FALSE(showsSomething(noColour));

    const RgbdFrame nothing = withoutImages(frame);
    EXPECT_TRUE(nothing.gray.empty());
    EXPECT_TRUE(nothing.depth.empty());
    EXPECT_FALSE(showsSomething(nothing));

    EXPECT_EQ(numReadings(frame.depth), 640 * 480);
    EXPECT_GT(cv::countNonZero(frame.gray), 600 * 480);
}

TEST(FrameChanges, DepthUpToARangeKeepsWhatIsNearer)
{
    const RgbdFrame frame = slantedPlane();
    const cv::Mat cut = withDepthUpTo(frame, 1.7F).depth;
    for (int u = 0; u < 640; ++u)
    {
        const float z = frame.depth.at<float>(100, u);
        if (z > 1.7F)
        {
            EXPECT_NE(cut.at<float>(100, u), cut.at<float>(100, u));
        }
        else
        {
            EXPECT_EQ(cut.at<float>(100, u), z);
        }
    }
    EXPECT_EQ(numReadings(frame.depth), 640 * 480);
}

TEST(FrameChanges, ShrunkFrameShowsTheSamePlaneThroughItsOwnCamera)
{
    const RgbdFrame frame = slantedPlane();
    for (const int factor : {2, 4})
    {
        const RgbdFrame small = shrunk(frame, factor);
        ASSERT_EQ(small.camera.width, 640 / factor);
        ASSERT_EQ(small.gray.size(), cv::Size(640 / factor, 480 / factor));
        ASSERT_EQ(small.depth.size(), small.gray.size());
        for (int v = 0; v < small.depth.rows; v += 17)
        {
            for (int u = 0; u < small.depth.cols; u += 13)
            {
                // The ray of the small pixel, in pixels of the large image.
                const double x = (u - small.camera.cx) / small.camera.fx;
                const double y = (v - small.camera.cy) / small.camera.fy;
                const double U = frame.camera.cx + frame.camera.fx * x;
                const double V = frame.camera.cy + frame.camera.fy * y;
                const double expected = 1 / (0.5 + 2e-4 * U + 1e-4 * V);
                EXPECT_NEAR(static_cast<double>(small.depth.at<float>(v, u)), expected, 1e-5);
                EXPECT_NEAR(small.gray.at<uchar>(v, u), (U - 1.5) / 4, 1.0);
            }
        }
    }
}

TEST(FrameChanges, ShrunkDepthDoesNotMixSurfaces)
{
    RgbdFrame frame = slantedPlane();
    frame.depth.setTo(3.0F);
    frame.depth.colRange(0, 201).setTo(1.0F);  // the edge runs through a block
    frame.depth.colRange(400, 640).setTo(kNone);
    frame.depth.colRange(500, 501).setTo(2.0F);
    const cv::Mat depth = shrunk(frame, 2).depth;
    EXPECT_EQ(depth.at<float>(50, 99), 1.0F);
    EXPECT_EQ(depth.at<float>(50, 100), 1.0F);
    EXPECT_EQ(depth.at<float>(50, 101), 3.0F);
    EXPECT_EQ(depth.at<float>(50, 250), 2.0F);
    EXPECT_NE(depth.at<float>(50, 260), depth.at<float>(50, 260));
}

TEST(FrameChanges, HolesAreOtherOnesInEachFrameAndTheSameInEachRun)
{
    RgbdFrame frame = slantedPlane();
    const cv::Mat first = withHoles(frame, 0.6).depth;
    EXPECT_NEAR(numReadings(first), 0.4 * 640 * 480, 1500);
    EXPECT_EQ(cv::countNonZero(first == withHoles(frame, 0.6).depth), numReadings(first));
    frame.stamp += 0.033;
    EXPECT_NEAR(cv::countNonZero(first == withHoles(frame, 0.6).depth), 0.16 * 640 * 480, 1500);
    EXPECT_EQ(numReadings(frame.depth), 640 * 480) << "the given frame is as it was";
}

TEST(FrameChanges, NoiseOfDepthGrowsWithItsSquareAndMissingDepthStaysMissing)
{
    RgbdFrame frame = slantedPlane();
    frame.depth.at<float>(3, 4) = kNone;
    const cv::Mat noisy = withNoisyDepth(frame, 0.004).depth;
    cv::Mat_<float> standard;
    cv::divide(noisy - frame.depth, frame.depth.mul(frame.depth), standard);
    standard(3, 4) = 0;
    EXPECT_NEAR(cv::norm(standard) / std::sqrt(640 * 480), 0.004, 1e-4);
    EXPECT_NEAR(cv::mean(standard)[0], 0, 1e-4);
    EXPECT_EQ(numReadings(noisy), 640 * 480 - 1);
}

TEST(FrameChanges, DimLightTakesContrastAndAddsNoise)
{
    const RgbdFrame frame = slantedPlane();
    const cv::Mat gray = dimmed(frame, 0.25, 3).gray;
    cv::Mat_<float> difference;
    cv::Mat(gray).convertTo(difference, CV_32F);
    cv::Mat_<float> given;
    frame.gray.convertTo(given, CV_32F, 0.25);
    difference -= given;
    const cv::Rect bright(480, 0, 160, 480);  // no clipping at black
    EXPECT_NEAR(cv::mean(difference(bright))[0], 0, 0.1);
    EXPECT_NEAR(cv::norm(difference(bright)) / std::sqrt(160 * 480), 3, 0.1);
    EXPECT_EQ(frame.gray.at<uchar>(0, 639), 159) << "the given frame is as it was";
}

TEST(FrameChanges, MarksInTheImagesAreTheSameInEachFrame)
{
    RgbdFrame frame = slantedPlane();
    const cv::Mat given = frame.gray.clone();
    for (const auto& change : {withText, withSpots})
    {
        const cv::Mat marks = change(frame).gray != given;
        EXPECT_GT(cv::countNonZero(marks), 0.01 * 640 * 480);
        EXPECT_LT(cv::countNonZero(marks), 0.2 * 640 * 480);
        EXPECT_EQ(cv::countNonZero(frame.gray != given), 0) << "the given frame is as it was";
        RgbdFrame dark = frame;
        dark.gray = cv::Mat(given.size(), CV_8UC1, cv::Scalar(0));
        dark.stamp += 1;
        EXPECT_EQ(cv::countNonZero((change(dark).gray > 0) != marks), 0);
    }
}
