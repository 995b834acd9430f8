// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/ColourSensor.h>

#include <opencv2/core.hpp>

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
cv::Mat grey(int level) { return {480, 640, CV_8UC3, cv::Scalar::all(level)}; }
}  // namespace

TEST(ColourSensor, idealPictureIsUnchanged)
{
    const cv::Mat out = ColourSensor(SimulationParams::ideal(), 1).sense({grey(90)}, 0, 1);
    EXPECT_EQ(cv::norm(out, grey(90), cv::NORM_INF), 0);
}

TEST(ColourSensor, noiseHasTheSigmaAskedForAndGrowsWithBrightness)
{
    SimulationParams params = SimulationParams::ideal();
    params.imageNoise = 4;
    const ColourSensor sensor(params, 1);
    double previous = 0;
    for (const int level : {40, 128, 200})
    {
        cv::Scalar mean, sigma;
        cv::meanStdDev(sensor.sense({grey(level)}, 0, 7), mean, sigma);
        EXPECT_NEAR(mean[0], level, 0.1);
        EXPECT_GT(sigma[1], previous);
        previous = sigma[1];
        if (level == 128)
        {
            // Rounding to integers adds 1/12.
            EXPECT_NEAR(sigma[2], std::sqrt(16 + 1.0 / 12), 0.05);
        }
    }
}

TEST(ColourSensor, inLowLightShotNoiseGrowsByTheRootOfTheGain)
{
    SimulationParams params = SimulationParams::ideal();
    params.imageNoise = 1.5;
    params.light = 0.1;
    const ColourSensor sensor(params, 1);
    for (const int level : {64, 128})
    {
        cv::Scalar mean, sigma;
        cv::meanStdDev(sensor.sense({grey(level)}, 0, 7), mean, sigma);
        EXPECT_NEAR(mean[0], level, 0.2) << "the gain keeps the brightness";
        const double variance = 1.5 * 1.5 * (0.5 / 0.01 + level / 256.0 / 0.1);
        EXPECT_NEAR(sigma[1], std::sqrt(variance + 1.0 / 12), 0.1);
    }
}

/** Of an edge between black and white. The three pixels of the smallest kernel cut a little off. */
TEST(ColourSensor, blurHasTheSigmaAskedFor)
{
    SimulationParams params = SimulationParams::ideal();
    for (const auto& [asked, sigma] :
         {std::pair(0.5, 0.46), std::pair(1.0, 1.0), std::pair(2.0, 2.0), std::pair(5.0, 5.0)})
    {
        params.lensBlurPx = asked;
        cv::Mat edge = grey(0);
        edge.colRange(320, 640).setTo(cv::Scalar::all(255));
        const cv::Mat out = ColourSensor(params, 1).sense({edge}, 0, 1);
        double square = 0;
        for (int u = 280; u < 360; ++u)
        {
            const int step = out.at<cv::Vec3b>(9, u)[0] - out.at<cv::Vec3b>(9, u - 1)[0];
            square += step / 255.0 * (u - 320) * (u - 320);
        }
        EXPECT_NEAR(std::sqrt(square), sigma, 0.06 * sigma);
    }
}

TEST(ColourSensor, vignettingDarkensCorners)
{
    SimulationParams params = SimulationParams::ideal();
    params.vignetting = 0.2;
    const cv::Mat out = ColourSensor(params, 1).sense({grey(200)}, 0, 1);
    EXPECT_NEAR(out.at<cv::Vec3b>(240, 320)[0], 200, 1);
    EXPECT_NEAR(out.at<cv::Vec3b>(0, 0)[0], 160, 1);
}

TEST(ColourSensor, exposuresAreAveraged)
{
    const cv::Mat out =
        ColourSensor(SimulationParams::ideal(), 1).sense({grey(10), grey(50), grey(90)}, 0, 1);
    EXPECT_EQ(cv::norm(out, grey(50), cv::NORM_INF), 0);
}

TEST(ColourSensor, exposureSwingChangesBrightnessOverTimeWithinItsAmplitude)
{
    SimulationParams params = SimulationParams::ideal();
    params.exposureSwing = 0.3;
    const ColourSensor sensor(params, 1);
    double low = 255, high = 0;
    for (double t = 0; t < 20; t += 0.5)
    {
        const double level = cv::mean(sensor.sense({grey(100)}, t, 1))[0];
        low = std::min(low, level);
        high = std::max(high, level);
    }
    EXPECT_GE(low, 69);
    EXPECT_LE(high, 131);
    EXPECT_GT(high - low, 30);
}
}  // namespace pointplane
