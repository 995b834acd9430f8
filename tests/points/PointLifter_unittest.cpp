// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/points/PointLifter.h>

#include <opencv2/core.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "matchers.h"
#include "monte_carlo.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

namespace
{
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

RgbdFrame wall(float z)
{
    RgbdFrame frame;
    frame.camera.fx = frame.camera.fy = 500;
    frame.camera.cx = 320;
    frame.camera.cy = 240;
    frame.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(z));
    return frame;
}

PointLifter::TParams nearest()
{
    PointLifter::TParams params;
    params.depthModel = "nearest";
    return params;
}

/** Keeps points on depth edges, where the mixture is at its most interesting. */
PointLifter edgeKeepingLifter()
{
    PointLifter::TParams params;
    params.maxEdgeSigmas = 0;
    return {params, DepthNoise{}};
}
}  // namespace

TEST(PointLifter, wallByHand)
{
    const RgbdFrame frame = wall(2);
    for (const std::string model : {"nearest", "mixture"})
    {
        PointLifter::TParams params;
        params.depthModel = model;
        const auto point = PointLifter(params, DepthNoise{}).lift(frame, {570.25, 240});
        ASSERT_TRUE(point) << model;
        EXPECT_THAT(point->p_cam.mean, IsMatrixNear(Eigen::Vector3d(1.001, 0, 2), 1e-7));
        EXPECT_THAT(point->uv_px, IsMatrixNear(Eigen::Vector2d(570.25, 240), 0.0));
        // A wall adds no spread: the sensor's own covariance [P17 Eq. 2].
        const PointGaussian expected = backProject(frame.camera, DepthNoise{}, {570.25, 240}, 2);
        EXPECT_LT(whitenedDifference(point->p_cam.cov, expected.cov), 1e-5) << model;
    }
}

/** 570.25 px is 1.001 m beside the axis at 2 m. Across the ray, it is as certain as the pixel. */
TEST(PointLifter, withoutDepthAPointIsAnywhereAlongItsRay)
{
    const PointFeature point = PointLifter(DepthNoise{}).onRay(wall(kNan), {570.25, 240}, 2);
    EXPECT_FALSE(point.hasDepth);
    EXPECT_THAT(point.p_cam.mean, IsMatrixNear(Eigen::Vector3d(1.001, 0, 2), 1e-12));
    const Eigen::Vector3d across = Eigen::Vector3d(2, 0, -1.001).normalized();
    const double sigmaPixel = 2 * DepthNoise{}.sigmaPixelPx / 500;
    EXPECT_NEAR(std::sqrt(across.dot(point.p_cam.cov * across)), sigmaPixel * across.x(), 1e-9);
    EXPECT_NEAR(std::sqrt(point.p_cam.cov(2, 2)), 2, 1e-9);
}

/** [P17 Eq. 1]: "the respective depth pixel value", whatever is beside it. */
TEST(PointLifter, nearestIsOneReading)
{
    RgbdFrame frame = wall(kNan);
    frame.depth.at<float>(100, 200) = 2;
    frame.depth.at<float>(101, 200) = 5;
    PointLifter::TParams params = nearest();
    params.maxEdgeSigmas = 0;
    const auto point = PointLifter(params, DepthNoise{}).lift(frame, {200.4, 99.6});
    ASSERT_TRUE(point);
    EXPECT_EQ(point->p_cam.mean.z(), 2);
    EXPECT_NEAR(point->p_cam.cov(2, 2), std::pow(1.425e-3 * 4, 2), 1e-12);
    EXPECT_FALSE(PointLifter(nearest(), DepthNoise{}).lift(frame, {200.4, 99.6})) << "at an edge";
}

TEST(PointLifter, mixtureByHand)
{
    // Centre column at 2 m, the rest at 3 m: weights 8 and 8.
    RgbdFrame frame = wall(3);
    frame.depth.col(320).setTo(2);
    const auto point = edgeKeepingLifter().lift(frame, {320, 240});
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->p_cam.mean.z(), 2.5, 1e-7);
    const DepthNoise noise;
    const double within = 0.5 * (std::pow(noise.sigmaZ(2), 2) + std::pow(noise.sigmaZ(3), 2));
    EXPECT_NEAR(point->p_cam.cov(2, 2), within + 0.25, 1e-6);
}

/** Where depth has holes, the pixel's own reading is enough. */
TEST(PointLifter, mixtureOfWhatThereIs)
{
    RgbdFrame frame = wall(kNan);
    EXPECT_FALSE(edgeKeepingLifter().lift(frame, {320, 240}));
    frame.depth.at<float>(240, 320) = 2;
    const auto one = edgeKeepingLifter().lift(frame, {320, 240});
    ASSERT_TRUE(one);
    EXPECT_NEAR(one->p_cam.mean.z(), 2, 1e-7);
    EXPECT_NEAR(one->p_cam.cov(2, 2), std::pow(DepthNoise{}.sigmaZ(2), 2), 1e-9);
    frame.depth.at<float>(240, 321) = 2.3F;  // beside the pixel: half of its weight
    const auto two = edgeKeepingLifter().lift(frame, {320, 240});
    ASSERT_TRUE(two);
    EXPECT_NEAR(two->p_cam.mean.z(), 2.1, 1e-6);
}

TEST(PointLifter, mixtureVarianceMatchesMonteCarlo)
{
    RgbdFrame frame = wall(3);
    frame.depth.rowRange(0, 240).setTo(2.6);
    const auto point = PointLifter(DepthNoise{}).lift(frame, {320, 240});
    ASSERT_TRUE(point);
    GaussianSampler random(91);
    const DepthNoise noise;
    double sum = 0, squared = 0;
    constexpr int kSamples = 40000;
    for (int i = 0; i < kSamples; ++i)
    {
        const double mean = random.uniform(0, 16) < 4 ? 2.6 : 3;  // weights 1 2 1 of 16
        const double z = mean + noise.sigmaZ(mean) * random.normal();
        sum += z / kSamples;
        squared += z * z / kSamples;
    }
    EXPECT_NEAR(point->p_cam.mean.z(), sum, 0.005);
    EXPECT_NEAR(point->p_cam.cov(2, 2), squared - sum * sum, 0.02 * point->p_cam.cov(2, 2));
}

TEST(PointLifter, edgesCanBeDropped)
{
    RgbdFrame frame = wall(3);
    frame.depth.colRange(0, 320).setTo(2);
    PointLifter::TParams params;
    params.maxEdgeSigmas = 3;
    const PointLifter lifter(params, DepthNoise{});
    EXPECT_FALSE(lifter.lift(frame, {320, 240}));
    EXPECT_FALSE(lifter.lift(frame, {319, 240}));
    EXPECT_TRUE(lifter.lift(frame, {321.4, 240}));
    EXPECT_TRUE(lifter.lift(frame, {317, 240}));
}

TEST(PointLifter, missingDepth)
{
    RgbdFrame frame = wall(2);
    frame.depth.at<float>(100, 100) = kNan;
    EXPECT_TRUE(PointLifter(DepthNoise{}).lift(frame, {100, 100})) << "the ring is there";
    EXPECT_FALSE(PointLifter(nearest(), DepthNoise{}).lift(frame, {100, 100}));
    frame.depth(cv::Rect(100, 100, 3, 3)).setTo(kNan);
    EXPECT_FALSE(PointLifter(DepthNoise{}).lift(frame, {101, 101})) << "none remains";
    EXPECT_FALSE(PointLifter(DepthNoise{}).lift(frame, {101, 100})) << "3 of 9 remain";
    EXPECT_TRUE(PointLifter(DepthNoise{}).lift(frame, {100, 100})) << "5 of 9 remain";
    frame.depth.at<float>(101, 101) = 2;
    EXPECT_TRUE(PointLifter(DepthNoise{}).lift(frame, {101, 101})) << "its own alone";
}

TEST(PointLifter, rangeAndBordersAndNonsense)
{
    for (const float z : {0.0F, -1.0F, 0.01F, 101.0F, kNan, std::numeric_limits<float>::infinity()})
    {
        EXPECT_FALSE(PointLifter(DepthNoise{}).lift(wall(z), {320, 240})) << z;
        EXPECT_FALSE(PointLifter(nearest(), DepthNoise{}).lift(wall(z), {320, 240})) << z;
    }
    for (const float z : {0.1F, 0.2F, 11.0F, 20.0F})
    {
        EXPECT_TRUE(PointLifter(DepthNoise{}).lift(wall(z), {320, 240})) << z;
    }
    const RgbdFrame frame = wall(2);
    const PointLifter lifter(nearest(), DepthNoise{});
    EXPECT_TRUE(lifter.lift(frame, {-0.4, 479.4}));
    EXPECT_FALSE(lifter.lift(frame, {-0.6, 240}));
    EXPECT_FALSE(lifter.lift(frame, {320, 479.6}));
    EXPECT_FALSE(lifter.lift(frame, {std::nan(""), 240}));
    EXPECT_FALSE(lifter.lift(frame, {1e300, 240}));
    EXPECT_FALSE(lifter.lift(RgbdFrame{}, {320, 240})) << "no depth image";
}

TEST(PointLifter, readsDepthWhereTheRayGoes)
{
    // Depth rises by a millimetre a column: the reading tells which column was read.
    RgbdFrame frame = wall(1);
    frame.camera.distortion = {{0.26, -0.95, -0.005, 0.003, 1.16}};
    for (int u = 0; u < 640; ++u)
    {
        frame.depth.col(u).setTo(1 + 0.001 * u);
    }
    const Eigen::Vector2d raw(40, 60);
    const Eigen::Vector2d undistorted = frame.camera.depthPixel(raw);
    ASSERT_GT(std::abs(undistorted.x() - raw.x()), 2);
    const auto point = PointLifter(nearest(), DepthNoise{}).lift(frame, raw);
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->p_cam.mean.z(), 1 + 0.001 * std::round(undistorted.x()), 1e-6);
    EXPECT_THAT(frame.camera.project(point->p_cam.mean), IsMatrixNear(raw, 1e-6));
}

TEST(PointLifter, listKeepsTrackOfRows)
{
    RgbdFrame frame = wall(2);
    frame.depth(cv::Rect(0, 0, 50, 480)).setTo(kNan);
    const LiftedPoints lifted =
        PointLifter(DepthNoise{}).liftAll(frame, {{10, 10}, {300, 10}, {20, 20}, {400, 30}});
    ASSERT_EQ(lifted.points.size(), 2u);
    EXPECT_EQ(lifted.index, (std::vector<int>{1, 3}));
    EXPECT_EQ(lifted.points[1].uv_px.x(), 400);
}

TEST(PointLifter, covarianceIsPositiveDefinite)
{
    RgbdFrame frame = wall(3);
    frame.depth.colRange(0, 320).setTo(0.5);
    for (const double u : {2.0, 319.0, 320.0, 637.0})
    {
        const auto point = edgeKeepingLifter().lift(frame, {u, 7});
        ASSERT_TRUE(point);
        EXPECT_TRUE(isPositiveDefinite(point->p_cam.cov));
    }
}

TEST(PointLifter, checkNamesTheKey)
{
    PointLifter::TParams params;
    params.depthModel = "linear";
    EXPECT_THROW(PointLifter(params, DepthNoise{}), std::invalid_argument);
    params = {};
    params.maxDepth = 0.01;
    EXPECT_THROW(PointLifter(params, DepthNoise{}), std::invalid_argument);
}
