// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/ObservationBuilder.h>

#include <cstdint>

#include <gtest/gtest.h>

namespace
{
using namespace pointplane;

/** The same colour in ITU-R BT.601, 8 bit, and in BGR. */
struct PackedColour
{
    std::uint8_t y, u, v;
    cv::Vec3b bgr;
};
const PackedColour kRed{81, 90, 240, {0, 0, 255}}, kBlue{41, 240, 110, {255, 0, 0}};

CameraImage twoPixels(PixelLayout layout, const cv::Mat& pixels)
{
    CameraImage image;
    image.stream = StreamKind::Colour;
    image.layout = layout;
    image.pixels = pixels;
    return image;
}

void expectColour(const cv::Mat& bgr, const cv::Vec3b& expected)
{
    ASSERT_EQ(bgr.type(), CV_8UC3);
    ASSERT_EQ(bgr.size(), cv::Size(2, 1));
    for (int x = 0; x < 2; ++x)
    {
        for (int channel = 0; channel < 3; ++channel)
        {
            EXPECT_NEAR(bgr.at<cv::Vec3b>(0, x)[channel], expected[channel], 2)
                << "pixel " << x << ", channel " << channel;
        }
    }
}

TEST(ObservationBuilder, coloursOfEveryLayoutComeOutAsBgr)
{
    for (const auto& c : {kRed, kBlue})
    {
        const cv::Mat rgb(1, 2, CV_8UC3, cv::Scalar(c.bgr[2], c.bgr[1], c.bgr[0]));
        expectColour(toBgr(twoPixels(PixelLayout::Rgb8, rgb)), c.bgr);

        const cv::Mat yuyv =
            (cv::Mat_<cv::Vec2b>(1, 2) << cv::Vec2b(c.y, c.u), cv::Vec2b(c.y, c.v));
        expectColour(toBgr(twoPixels(PixelLayout::Yuyv, yuyv)), c.bgr);

        const cv::Mat uyvy =
            (cv::Mat_<cv::Vec2b>(1, 2) << cv::Vec2b(c.u, c.y), cv::Vec2b(c.v, c.y));
        expectColour(toBgr(twoPixels(PixelLayout::Uyvy, uyvy)), c.bgr);
    }
}

TEST(ObservationBuilder, greyStaysGreyAndDepthKeepsItsCounts)
{
    ImagePair pair;
    pair.stamp = 1700000000.25;
    pair.colour =
        twoPixels(PixelLayout::Gray8, (cv::Mat_<std::uint8_t>(1, 2) << std::uint8_t{7}, 200));
    pair.depth.pixels = (cv::Mat_<std::uint16_t>(1, 2) << std::uint16_t{0}, 54321);
    pair.depth.depthUnit = 1e-4;
    mrpt::obs::CObservation3DRangeScan observation;
    ObservationBuilder(RgbdCalibration{}).fill(pair, observation);

    EXPECT_NEAR(mrpt::Clock::toDouble(observation.timestamp), pair.stamp, 1e-6);
    ASSERT_TRUE(observation.hasIntensityImage);
    EXPECT_FALSE(observation.intensityImage.isColor());
    EXPECT_EQ(observation.intensityImage.at<std::uint8_t>(0, 0), 7);
    EXPECT_EQ(observation.intensityImage.at<std::uint8_t>(1, 0), 200);
    EXPECT_FLOAT_EQ(observation.rangeUnits, 1e-4F);
    ASSERT_EQ(observation.rangeImage.cols(), 2);
    EXPECT_EQ(observation.rangeImage(0, 0), 0);
    EXPECT_EQ(observation.rangeImage(0, 1), 54321);
}
}  // namespace
