// SPDX-License-Identifier: BSD-3-Clause
#include "image_noise.h"

#include <cmath>

#include "texture.h"
#include <gtest/gtest.h>

using namespace pointplane;

TEST(ImageNoise, IsThatOfTheImage)
{
    for (const double sigma : {1.5, 3.0, 6.0})
    {
        EXPECT_NEAR(imageNoise(test::blankWall(sigma)), std::hypot(sigma, 0.29), 0.25);
    }
}

TEST(ImageNoise, SeesPastTexture)
{
    const test::Texture texture(1, 8, 80);
    test::GaussianSampler random(3);
    EXPECT_LT(imageNoise(test::renderImage(640, 480, texture, 2, &random)), 3.5);
}

TEST(ImageNoise, IsAtLeastThatOfRounding)
{
    EXPECT_DOUBLE_EQ(imageNoise(cv::Mat(480, 640, CV_8UC1, cv::Scalar(7))), 0.3);
    EXPECT_DOUBLE_EQ(imageNoise(cv::Mat(2, 2, CV_8UC1, cv::Scalar(7))), 0.3);
}
