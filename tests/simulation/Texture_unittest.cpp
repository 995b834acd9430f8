// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/Texture.h>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Blue rises by 3 a texel in x, green by 2 in y. */
cv::Mat ramp(int width, int height)
{
    cv::Mat out(height, width, CV_8UC3);
    for (int y = 0; y < height; ++y)
    {
        for (int x = 0; x < width; ++x)
        {
            out.at<cv::Vec3b>(y, x) =
                cv::Vec3b(static_cast<uchar>(3 * x), static_cast<uchar>(2 * y), 200);
        }
    }
    return out;
}
int blue(std::uint64_t lanes) { return static_cast<int>(lanes & 0xff); }
int green(std::uint64_t lanes) { return static_cast<int>(lanes >> 16 & 0xff); }
int red(std::uint64_t lanes) { return static_cast<int>(lanes >> 32 & 0xff); }
}  // namespace

TEST(Texture, interpolatesBetweenTexelsOfEveryLevel)
{
    const Texture texture(ramp(64, 64), 0.01);
    for (const float lod : {0.0F, 0.5F, 1.0F, 1.6F, 2.0F})
    {
        for (float x = 10; x < 50; x += 1.37F)
        {
            const float y = 60 - x;
            const std::uint64_t lanes = texture.sample(x, y, lod);
            EXPECT_NEAR(blue(lanes), 3 * x, 1.5) << "x " << x << " lod " << lod;
            EXPECT_NEAR(green(lanes), 2 * y, 1.5) << "y " << y << " lod " << lod;
            EXPECT_EQ(red(lanes), 200);
        }
    }
}

TEST(Texture, coarseLevelsAreAverages)
{
    cv::Mat stripes(32, 32, CV_8UC3, cv::Scalar(0, 0, 0));
    for (int x = 0; x < 32; x += 2)
    {
        stripes.col(x).setTo(cv::Scalar(200, 100, 50));
    }
    const Texture texture(stripes, 0.01);
    EXPECT_NEAR(blue(texture.sample(9.3F, 9, 1)), 100, 1);
    EXPECT_NEAR(red(texture.sample(9.3F, 9, 2)), 25, 1);
}

TEST(Texture, staysInsideThePicture)
{
    const Texture texture(ramp(17, 9), 0.01);
    EXPECT_EQ(blue(texture.sample(-1e4F, 4, -3)), 0);
    EXPECT_NEAR(blue(texture.sample(1e4F, 4, 0)), 48, 1);
    EXPECT_NEAR(green(texture.sample(3, 1e4F, 20)), 12, 5);
}

TEST(Texture, refusesPicturesItCannotInterpolate)
{
    EXPECT_THROW(Texture(cv::Mat(3, 9, CV_8UC3), 0.01), std::invalid_argument);
    EXPECT_THROW(Texture(cv::Mat(9, 9, CV_8UC1), 0.01), std::invalid_argument);
}
}  // namespace pointplane
