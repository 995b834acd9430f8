// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/points/ImagePyramid.h>

#include <opencv2/core.hpp>

#include <stdexcept>

#include "texture.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

TEST(ImagePyramid, halvesTheImage)
{
    const ImagePyramid pyramid(cv::Mat(480, 640, CV_8UC1, cv::Scalar(77)), 4);
    ASSERT_EQ(pyramid.numLevels(), 4);
    EXPECT_EQ(pyramid.level(3).size(), cv::Size(80, 60));
    EXPECT_EQ(pyramid.level(3).at<uint8_t>(30, 40), 77);
}

TEST(ImagePyramid, pixelLiesAtPowerOfTwo)
{
    // A texture coarse enough for three halvings: level L at p shows level 0 at p 2^L.
    const Texture texture(1, 60, 120);
    const ImagePyramid pyramid(renderImage(320, 240, texture), 3);
    for (int level = 1; level < 3; ++level)
    {
        const cv::Mat& image = pyramid.level(level);
        for (int v = 4; v < image.rows - 4; ++v)
        {
            for (int u = 4; u < image.cols - 4; ++u)
            {
                EXPECT_NEAR(image.at<uint8_t>(v, u), texture(u << level, v << level), 4);
            }
        }
    }
}

TEST(ImagePyramid, ownsItsImage)
{
    cv::Mat image(64, 64, CV_8UC1, cv::Scalar(10));
    const ImagePyramid pyramid(image, 2);
    image.setTo(200);
    EXPECT_EQ(pyramid.level(0).at<uint8_t>(5, 5), 10);
}

TEST(ImagePyramid, stopsBeforeImagesVanish)
{
    EXPECT_EQ(ImagePyramid(cv::Mat::zeros(48, 400, CV_8UC1), 6).numLevels(), 2);
    EXPECT_EQ(ImagePyramid(cv::Mat::zeros(3, 3, CV_8UC1), 6).numLevels(), 1);
}

TEST(ImagePyramid, refusesWhatIsNotAGrayImage)
{
    EXPECT_THROW(ImagePyramid(cv::Mat(), 2), std::invalid_argument);
    EXPECT_THROW(ImagePyramid(cv::Mat::zeros(64, 64, CV_8UC3), 2), std::invalid_argument);
    EXPECT_THROW(ImagePyramid(cv::Mat::zeros(64, 64, CV_8UC1), 0), std::invalid_argument);
}
