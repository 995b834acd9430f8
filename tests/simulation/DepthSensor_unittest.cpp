// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/DepthSensor.h>

#include <opencv2/core.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kWidth = 640, kHeight = 480;

/** A camera with one effect at a time. */
SimulationParams only() { return SimulationParams::ideal(); }

Scene sceneOf(int surfaces)
{
    Scene scene;
    scene.surfaces.resize(static_cast<std::size_t>(surfaces));
    return scene;
}

CastImage wall(double z)
{
    return {
        cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(1 / z)),
        cv::Mat(kHeight, kWidth, CV_32SC1, cv::Scalar(0))};
}

/** A plane through the axis at z, its normal turned by `angle` about the image's y axis. */
CastImage slantedWall(const PinholeCamera& camera, double z, double angle)
{
    CastImage out = wall(z);
    for (int v = 0; v < kHeight; ++v)
    {
        for (int u = 0; u < kWidth; ++u)
        {
            const double x = (u - camera.cx) / camera.fx;
            out.inverseDepth.at<float>(v, u) =
                static_cast<float>(std::max(0.0, (1 + std::tan(angle) * x) / z));
        }
    }
    return out;
}

/** Wall at 2 m with a box at 1 m in columns 300 to 339. */
CastImage boxBeforeWall()
{
    CastImage out = wall(2);
    out.inverseDepth.colRange(300, 340).setTo(1.0);
    out.ids.colRange(300, 340).setTo(1);
    return out;
}

bool isMissing(const cv::Mat& depth, int u, int v = 240)
{
    return std::isnan(depth.at<float>(v, u));
}

struct Statistics
{
    double mean{0}, sigma{0}, correlation4{0}, correlation12{0};
};

/** Of inverse-depth errors over frames of a wall. */
Statistics inverseDepthErrors(const SimulationParams& params, const CastImage& cast, int frames)
{
    const Scene scene = sceneOf(1);
    const DepthSensor sensor(params, scene);
    double n = 0, s1 = 0, s2 = 0, c4 = 0, c12 = 0;
    for (int k = 0; k < frames; ++k)
    {
        const cv::Mat depth = sensor.sense(cast, static_cast<std::uint64_t>(k));
        for (int v = 5; v < kHeight; v += 7)
        {
            const auto error = [&](int u)
            {
                return 1.0 / static_cast<double>(depth.at<float>(v, u)) -
                       static_cast<double>(cast.inverseDepth.at<float>(v, u));
            };
            for (int u = 20; u < kWidth - 20; u += 5)
            {
                const double e = error(u);
                n += 1;
                s1 += e;
                s2 += e * e;
                c4 += e * error(u + 4);
                c12 += e * error(u + 12);
            }
        }
    }
    return {s1 / n, std::sqrt(s2 / n), c4 / s2, c12 / s2};
}
}  // namespace

TEST(DepthSensor, idealReadingsAreTheTruth)
{
    const Scene scene = sceneOf(1);
    const cv::Mat depth = DepthSensor(only(), scene).sense(wall(1.7), 1);
    EXPECT_LT(
        cv::norm(depth, cv::Mat(depth.size(), CV_32FC1, cv::Scalar(1.7)), cv::NORM_INF), 1e-6);
}

TEST(DepthSensor, noiseIsConstantInInverseDepthAndCorrelatedOverTheWindow)
{
    SimulationParams params = only();
    params.sigmaInverseDepth = 1.4e-3;
    params.noiseWindowPx = 9;
    for (const double z : {0.8, 2.0, 5.0})
    {
        const Statistics s = inverseDepthErrors(params, wall(z), 12);
        EXPECT_NEAR(s.sigma, 1.4e-3, 0.03 * 1.4e-3) << z;
        EXPECT_NEAR(s.mean, 0, 5e-5);
        // Two windows of 9 that are 4 apart share 5.
        EXPECT_NEAR(s.correlation4, 5.0 / 9, 0.05);
        EXPECT_NEAR(s.correlation12, 0, 0.05);
    }
}

/** Interpolation takes of the noise, and how much depends on the grid. */
TEST(DepthSensor, noiseOfAnEnlargedImageIsAsStated)
{
    SimulationParams params = only();
    params.sigmaDepth = 0.002;
    const Scene scene = sceneOf(1);
    for (const int pixels : {1, 2, 3, 4})
    {
        params.upsampling = pixels;
        const cv::Mat depth = DepthSensor(params, scene).sense(wall(2), 1);
        const double norm = cv::norm(depth, cv::Mat(depth.size(), CV_32FC1, cv::Scalar(2)));
        EXPECT_NEAR(norm / std::sqrt(kWidth * kHeight), 0.002, 0.02 * 0.002) << pixels;
    }
}

/** At a half of the width, a sensor has as many pixels as before, and not a half of them. */
TEST(DepthSensor, measuredPixelsScaleWithTheImage)
{
    SimulationParams params = only();
    params.sigmaDepth = 0.002;
    params.upsampling = 2;
    params.width = kWidth / 2;
    params.height = kHeight / 2;
    const cv::Rect part(0, 0, params.width, params.height);
    const CastImage whole = wall(2),
                    cast{whole.inverseDepth(part).clone(), whole.ids(part).clone()};
    const Scene scene = sceneOf(1);
    const cv::Mat depth = DepthSensor(params, scene).sense(cast, 1);
    const cv::Mat step = depth.colRange(1, params.width) - depth.colRange(0, params.width - 1);
    const double rms = cv::norm(step) / std::sqrt(static_cast<double>(step.total()));
    EXPECT_NEAR(rms, std::sqrt(2) * 0.002, 0.03 * 0.002);  // neighbours are independent
}

/** Depths between box and wall, over two measured pixels; none elsewhere. */
TEST(DepthSensor, measuredPixelsMixBothSidesOfAnEdge)
{
    SimulationParams params = only();
    params.upsampling = 3;
    params.mixedPixels = true;
    const Scene scene = sceneOf(2);
    const cv::Mat depth = DepthSensor(params, scene).sense(boxBeforeWall(), 1);
    int between = 0;
    for (int u = 0; u < kWidth; ++u)
    {
        const float z = depth.at<float>(100, u);
        const bool nearEdge = std::abs(u - 299.5) < 5 || std::abs(u - 339.5) < 5;
        const bool isBetween = z > 1.01F && z < 1.99F;
        EXPECT_TRUE(nearEdge || !isBetween) << z << " at " << u;
        between += isBetween ? 1 : 0;
    }
    EXPECT_GE(between, 4);
    EXPECT_LE(between, 12);
}

/** The mean over a pixel of a slanted wall is the depth of its middle. */
TEST(DepthSensor, measuredPixelsLeaveSurfacesWhereTheyAre)
{
    SimulationParams params = only();
    params.upsampling = 3;
    params.mixedPixels = true;
    const Scene scene = sceneOf(1);
    const CastImage cast = slantedWall(params.camera(), 2, 0.5);
    const cv::Mat depth = DepthSensor(params, scene).sense(cast, 1);
    for (int u = 3; u + 3 < kWidth; ++u)
    {
        EXPECT_NEAR(depth.at<float>(100, u) * cast.inverseDepth.at<float>(100, u), 1, 1e-4) << u;
    }
}

/** What is too far gives no reading, nor a part of one. */
TEST(DepthSensor, measuredPixelsMixOnlyReadings)
{
    SimulationParams params = only();
    params.upsampling = 3;
    params.mixedPixels = true;
    params.maxDepth = 1.5;
    const Scene scene = sceneOf(2);
    const cv::Mat depth = DepthSensor(params, scene).sense(boxBeforeWall(), 1);
    for (int u = 0; u < kWidth; ++u)
    {
        EXPECT_EQ(isMissing(depth, u), u < 300 || u >= 340) << u;
        EXPECT_TRUE(isMissing(depth, u) || std::abs(depth.at<float>(100, u) - 1) < 1e-5F) << u;
    }
}

TEST(DepthSensor, quantisationIsPartOfTheTotalNoise)
{
    SimulationParams params = only();
    params.sigmaInverseDepth = 1.4e-3;
    params.disparityStepPx = 0.125;
    const PinholeCamera camera = params.camera();
    const Statistics s = inverseDepthErrors(params, slantedWall(camera, 2, 0.5), 12);
    EXPECT_NEAR(s.sigma, 1.4e-3, 0.04 * 1.4e-3);

    const Scene scene = sceneOf(1);
    const cv::Mat depth = DepthSensor(params, scene).sense(slantedWall(camera, 2, 0.5), 1);
    const double step = 0.125 / params.disparityPxMetre;
    for (int u = 0; u < kWidth; u += 3)
    {
        const double steps = 1.0 / static_cast<double>(depth.at<float>(100, u)) / step;
        EXPECT_NEAR(steps, std::round(steps), 1e-3);
    }
}

TEST(DepthSensor, stepsInDepthGrowWithItsSquare)
{
    SimulationParams params = only();
    params.disparityStepPx = 0.125;
    const Scene scene = sceneOf(1);
    const DepthSensor sensor(params, scene);
    const CastImage cast = slantedWall(params.camera(), 3, 0.8);
    const cv::Mat depth = sensor.sense(cast, 1);
    for (int u = 0; u + 1 < kWidth; ++u)
    {
        const double z = static_cast<double>(depth.at<float>(0, u));
        const double difference = std::abs(static_cast<double>(depth.at<float>(0, u + 1)) - z);
        // 2.9e-3 per metre: 2.9 mm at 1 m, 26 mm at 3 m.
        EXPECT_TRUE(difference == 0 || std::abs(difference / (z * z) - 2.87e-3) < 3e-4)
            << difference << " at " << z;
    }
}

/** Of which a reading has more than an integer holds. */
TEST(DepthSensor, tinyStepsAreNone)
{
    SimulationParams params = only();
    params.disparityStepPx = 1e-9;
    const Scene scene = sceneOf(1);
    const CastImage cast = slantedWall(params.camera(), 2, 0.5);
    const cv::Mat depth = DepthSensor(params, scene).sense(cast, 1);
    for (int u = 0; u < kWidth; u += 7)
    {
        EXPECT_NEAR(depth.at<float>(9, u) * cast.inverseDepth.at<float>(9, u), 1, 1e-5);
    }
}

TEST(DepthSensor, noReadingOutOfRange)
{
    SimulationParams params = only();
    params.minDepth = 0.4;
    params.maxDepth = 8;
    const Scene scene = sceneOf(1);
    const DepthSensor sensor(params, scene);
    EXPECT_TRUE(isMissing(sensor.sense(wall(0.39), 1), 100));
    EXPECT_FALSE(isMissing(sensor.sense(wall(0.41), 1), 100));
    EXPECT_FALSE(isMissing(sensor.sense(wall(7.9), 1), 100));
    EXPECT_TRUE(isMissing(sensor.sense(wall(8.1), 1), 100));
}

TEST(DepthSensor, noReadingOnSurfacesThatReturnNoInfrared)
{
    Scene scene = sceneOf(2);
    scene.surfaces[1].hasDepth = false;
    const cv::Mat depth = DepthSensor(only(), scene).sense(boxBeforeWall(), 1);
    EXPECT_TRUE(isMissing(depth, 320));
    EXPECT_FALSE(isMissing(depth, 100));
}

TEST(DepthSensor, shadowOfTheProjectorIsLeftOfTheBoxAndAsWideAsTheDisparityStep)
{
    SimulationParams params = only();
    params.shadowBaseline = 0.075;
    const Scene scene = sceneOf(2);
    const cv::Mat depth = DepthSensor(params, scene).sense(boxBeforeWall(), 1);
    // f b (1/1 - 1/2) = 525 * 0.075 * 0.5 = 19.7 px
    int missing = 0;
    for (int u = 0; u < kWidth; ++u)
    {
        missing += isMissing(depth, u) ? 1 : 0;
        EXPECT_TRUE(!isMissing(depth, u) || (u >= 279 && u < 300)) << u;
    }
    EXPECT_NEAR(missing, 19, 1);
}

TEST(DepthSensor, noReadingAtDepthEdges)
{
    SimulationParams params = only();
    params.edgeLossPx = 2;
    const Scene scene = sceneOf(2);
    const cv::Mat depth = DepthSensor(params, scene).sense(boxBeforeWall(), 1);
    for (int u = 250; u < 400; ++u)
    {
        const bool nearEdge = std::abs(u - 299.5) < 2 || std::abs(u - 339.5) < 2;
        EXPECT_EQ(isMissing(depth, u), nearEdge) << u;
    }
}

TEST(DepthSensor, noReadingOnSurfacesSeenTooFlat)
{
    SimulationParams params = only();
    params.maxIncidenceDeg = 70;
    const Scene scene = sceneOf(1);
    const DepthSensor sensor(params, scene);
    const double deg = 3.14159265358979323846 / 180;
    const PinholeCamera camera = params.camera();
    // On the axis the incidence is the wall's angle.
    EXPECT_FALSE(isMissing(sensor.sense(slantedWall(camera, 2, 68 * deg), 1), 320));
    EXPECT_TRUE(isMissing(sensor.sense(slantedWall(camera, 2, 72 * deg), 1), 320));
    // A ray 20 degrees to the side meets a wall of 60 degrees at 40 or 80.
    const int side = static_cast<int>(camera.fx * std::tan(20 * deg));
    const cv::Mat depth = sensor.sense(slantedWall(camera, 2, 60 * deg), 1);
    EXPECT_NE(isMissing(depth, 319 + side), isMissing(depth, 319 - side));
}

TEST(DepthSensor, raggedEdgesShowEitherSideAndNothingBetween)
{
    SimulationParams params = only();
    params.lateralSigmaPx = 0.6;
    const Scene scene = sceneOf(2);
    const cv::Mat depth = DepthSensor(params, scene).sense(boxBeforeWall(), 1);
    int swapped = 0;
    for (int v = 0; v < kHeight; ++v)
    {
        for (int u = 0; u < kWidth; ++u)
        {
            const float z = depth.at<float>(v, u);
            ASSERT_TRUE(z == 1.0F || z == 2.0F);
            const bool box = u >= 300 && u < 340;
            swapped += box != (z == 1.0F) ? 1 : 0;
            ASSERT_TRUE(box == (z == 1.0F) || std::abs(u - 320) < 24);
        }
    }
    EXPECT_GT(swapped, 2 * kHeight / 10);
    EXPECT_LT(swapped, 2 * kHeight);
}

TEST(DepthSensor, calibrationErrorIsSmoothAndTheSameInEveryFrame)
{
    SimulationParams params = only();
    params.calibrationSigma = 1e-3;
    const Scene scene = sceneOf(1);
    double s2 = 0;
    for (std::uint64_t camera = 0; camera < 20; ++camera)
    {
        const DepthSensor sensor(params, scene, camera);
        const cv::Mat a = 1.0 / sensor.sense(wall(2), 1), b = 1.0 / sensor.sense(wall(2), 2);
        EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0);
        EXPECT_LT(cv::norm(a.colRange(1, 640), a.colRange(0, 639), cv::NORM_INF), 1e-4);
        const cv::Mat error = a - 0.5;
        s2 += error.dot(error) / (640.0 * 480.0 * 20);
    }
    EXPECT_NEAR(std::sqrt(s2), 1e-3, 0.15e-3);
}
}  // namespace pointplane
