// SPDX-License-Identifier: BSD-3-Clause
#include "LatestImages.h"

#include <opencv2/core.hpp>

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using testing::StartsWith;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/** 4x3 pixels. */
RgbdFrame frameOf(float depth, int gray)
{
    RgbdFrame out;
    out.depth = cv::Mat(3, 4, CV_32FC1, cv::Scalar::all(static_cast<double>(depth)));
    out.gray = cv::Mat(3, 4, CV_8UC1, cv::Scalar::all(gray));
    return out;
}

std::string renew(LatestImages& images, RgbdFrame frame) { return images.renew(frame); }
}  // namespace

TEST(LatestImages, theCallerMayReuseItsBuffers)
{
    LatestImages images(0.1, 20);
    RgbdFrame caller = frameOf(2, 100);
    RgbdFrame own = caller;
    EXPECT_EQ(images.renew(own), "");
    caller.depth.setTo(7);
    caller.gray.setTo(7);
    EXPECT_EQ(own.depth.at<float>(1, 1), 2);
    EXPECT_EQ(own.gray.at<std::uint8_t>(1, 1), 100);
}

/** Who keeps a frame keeps its images, however many follow. */
TEST(LatestImages, imagesThatAreSharedStay)
{
    LatestImages images(0.1, 20);
    RgbdFrame kept = frameOf(2, 100);
    (void)images.renew(kept);
    for (int i = 1; i < 5; ++i)
    {
        (void)renew(images, frameOf(2.0F + static_cast<float>(i), 100 + i));
    }
    EXPECT_EQ(cv::countNonZero(kept.depth != 2), 0);
    EXPECT_EQ(cv::countNonZero(kept.gray != 100), 0);
}

TEST(LatestImages, whatIsOutOfRangeIsNoReading)
{
    LatestImages images(0.5, 4);
    RgbdFrame frame = frameOf(2, 100);
    const float inf = std::numeric_limits<float>::infinity();
    const float values[] = {0, kNaN, -1, 0.4F, 0.5F, 4, 4.1F, inf};
    for (int i = 0; i < 8; ++i)
    {
        frame.depth.at<float>(i / 4, i % 4) = values[i];
    }
    (void)images.renew(frame);
    for (int i = 0; i < 8; ++i)
    {
        const bool isReading = i == 4 || i == 5;
        EXPECT_EQ(std::isfinite(frame.depth.at<float>(i / 4, i % 4)), isReading) << values[i];
    }
}

TEST(LatestImages, theRobotIsNoReading)
{
    LatestImages images(0.1, 20);
    cv::Mat mask(3, 4, CV_8UC1, cv::Scalar::all(255));
    mask.at<std::uint8_t>(1, 2) = 0;
    images.setMask(mask);
    RgbdFrame frame = frameOf(2, 100);
    (void)images.renew(frame);
    EXPECT_TRUE(std::isnan(frame.depth.at<float>(1, 2)));
    EXPECT_EQ(images.mask().size(), cv::Size(4, 3));
    images.setMask({});
    frame = frameOf(3, 100);
    (void)images.renew(frame);
    EXPECT_EQ(frame.depth.at<float>(1, 2), 3);
    EXPECT_TRUE(images.mask().empty());
}

/** Also where the caller's readings out of range differ: they are none. */
TEST(LatestImages, repeatedImagesAreLeftOut)
{
    LatestImages images(0.1, 20);
    EXPECT_EQ(renew(images, frameOf(2, 100)), "");
    RgbdFrame frame = frameOf(2, 100);
    EXPECT_THAT(images.renew(frame), StartsWith("its images are those of the frame before"));
    EXPECT_TRUE(frame.gray.empty());
    EXPECT_TRUE(std::isnan(frame.depth.at<float>(0, 0)));

    frame = frameOf(2, 101);
    EXPECT_THAT(images.renew(frame), StartsWith("its depth image is that of the frame before"));
    EXPECT_EQ(frame.gray.at<std::uint8_t>(0, 0), 101);
    EXPECT_TRUE(std::isnan(frame.depth.at<float>(0, 0)));

    frame = frameOf(3, 101);
    EXPECT_THAT(images.renew(frame), StartsWith("its colour image is that of the frame before"));
    EXPECT_TRUE(frame.gray.empty());
    EXPECT_EQ(frame.depth.at<float>(0, 0), 3);

    EXPECT_EQ(renew(images, frameOf(4, 102)), "");
}

/** A camera in the dark, or with a hand before it, repeats nothing by which it could be told. */
TEST(LatestImages, depthWithoutReadingsIsNotRepeated)
{
    LatestImages images(0.1, 20);
    EXPECT_EQ(renew(images, frameOf(0, 100)), "");
    EXPECT_EQ(renew(images, frameOf(0, 101)), "");

    RgbdFrame depthAlone = frameOf(0, 101);
    depthAlone.gray.release();
    EXPECT_EQ(renew(images, depthAlone), "");
    EXPECT_EQ(renew(images, depthAlone), "");
}

TEST(LatestImages, anImageIsRepeatedAlsoAfterAFrameWithoutOne)
{
    LatestImages images(0.1, 20);
    EXPECT_EQ(renew(images, frameOf(2, 100)), "");
    RgbdFrame depthAlone = frameOf(3, 100);
    depthAlone.gray.release();
    EXPECT_EQ(renew(images, depthAlone), "");
    EXPECT_NE(renew(images, frameOf(4, 100)), "");
    EXPECT_EQ(renew(images, frameOf(5, 101)), "");
}

TEST(LatestImages, whatIsForgottenIsNotRepeated)
{
    LatestImages images(0.1, 20);
    (void)renew(images, frameOf(2, 100));
    images.forget();
    RgbdFrame frame = frameOf(2, 100);
    EXPECT_EQ(images.renew(frame), "");
    EXPECT_FALSE(frame.gray.empty());
    EXPECT_EQ(frame.depth.at<float>(0, 0), 2);
}

TEST(LatestImages, anotherSizeIsNoRepetition)
{
    LatestImages images(0.1, 20);
    (void)renew(images, frameOf(2, 100));
    RgbdFrame large;
    large.depth = cv::Mat(6, 8, CV_32FC1, cv::Scalar::all(2));
    EXPECT_EQ(images.renew(large), "");
    EXPECT_TRUE(large.gray.empty());
    EXPECT_EQ(large.depth.size(), cv::Size(8, 6));
}
}  // namespace pointplane
