// SPDX-License-Identifier: BSD-3-Clause
#include "correlated_pixels.h"

#include <pointplane/planes/PlaneFitter.h>

#include <opencv2/imgproc.hpp>

#include <cmath>
#include <numeric>

#include "linear_algebra.h"
#include "monte_carlo.h"
#include "synthetic_depth.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr double kPixelSigma = 1.425e-3;  // [1/m]

/** A slanted wall that fills the image, seen with inverse depths that are off by `errors`. */
struct Wall
{
    Wall(const cv::Mat& errors, int cellSize = 10)
    {
        const PinholeCamera camera = test::kinectCamera(errors.cols, errors.rows);
        cv::Mat depth = test::renderDepth(camera, {theta_m}, [](int, int) { return 0; });
        for (int v = 0; v < depth.rows; ++v)
        {
            for (int u = 0; u < depth.cols; ++u)
            {
                float& z = depth.at<float>(v, u);
                z = 1 / (1 / z + errors.at<float>(v, u));
            }
        }
        grid.compute(depth, camera, cellSize);
        plane.cells.resize(grid.moments.size());
        std::iota(plane.cells.begin(), plane.cells.end(), 0);
        for (const PlaneMoments& cell : grid.moments)
        {
            plane.moments += cell;
        }
        fit = *fitInverseDepth(plane.moments, {});
    }

    [[nodiscard]] double pixels() const
    {
        return correlatedPixels(plane, grid, fit.theta_m, fit.cov_m);
    }

    Eigen::Vector3d theta_m = test::thetaThrough({0, 0, 2}, {0.3, 0.2, -1});
    CellGrid grid;
    CellCluster plane;
    PlaneGaussian fit;
};

/** White noise, smoothed over a square of `side` pixels with its variance kept. */
cv::Mat noise(test::GaussianSampler& sampler, int side, cv::Size size = {320, 240})
{
    cv::Mat out(size, CV_32FC1);
    for (auto it = out.begin<float>(); it != out.end<float>(); ++it)
    {
        *it = static_cast<float>(kPixelSigma * sampler.vector<1>()[0]);
    }
    cv::blur(out, out, {side, side});
    return out * side;
}

/** Mean of the number, and NEES per degree of freedom of the fit with it. */
struct Consistency
{
    double pixels{0}, nees{0};
    Consistency(unsigned seed, int side)
    {
        constexpr int kRuns = 60;
        test::GaussianSampler sampler(seed);
        for (int run = 0; run < kRuns; ++run)
        {
            const Wall wall(noise(sampler, side));
            const double n = wall.pixels();
            pixels += n / kRuns;
            const Eigen::Vector3d error = wall.fit.theta_m - wall.theta_m;
            nees += test::squaredMahalanobis(error, n * wall.fit.cov_m) / (3 * kRuns);
        }
    }
};
}  // namespace

/** Of independent pixels only the prior is left: three of sixteen blocks whose cells err as one. */
TEST(correlatedPixels, independentOnes)
{
    const Consistency out(1, 1);
    EXPECT_NEAR(out.pixels, (13 * 1 + 3 * 100) / 16.0, 3);
    EXPECT_LT(out.nees, 0.3) << "the prior is cautious";
}

/** Smoothed over a square of side s, s^2 pixels err as one. */
TEST(correlatedPixels, smoothedOnesAsMonteCarlo)
{
    for (const int side : {10, 20})
    {
        const Consistency out(2, side);
        const double expected = (13 * side * side + 3 * 100) / 16.0;
        EXPECT_NEAR(out.pixels, expected, 0.25 * expected);
        EXPECT_GT(out.nees, 0.6);
        EXPECT_LT(out.nees, 1.7);
    }
}

/** A bowl of a tenth of the noise weighs like thousands of pixels. */
TEST(correlatedPixels, aBentImage)
{
    test::GaussianSampler sampler(3);
    cv::Mat errors = noise(sampler, 1);
    const double flat = Wall(errors).pixels();
    for (int v = 0; v < errors.rows; ++v)
    {
        for (int u = 0; u < errors.cols; ++u)
        {
            const double x = u / 160.0 - 1, y = v / 120.0 - 1;
            errors.at<float>(v, u) += static_cast<float>(kPixelSigma * (x * x + y * y));
        }
    }
    EXPECT_GT(Wall(errors).pixels(), 20 * flat);
}

/** It is a plane; nothing tells it from one. */
TEST(correlatedPixels, aTiltDoesNotShow)
{
    test::GaussianSampler sampler(4);
    cv::Mat errors = noise(sampler, 1);
    const double flat = Wall(errors).pixels();
    for (int v = 0; v < errors.rows; ++v)
    {
        errors.row(v) += 10 * kPixelSigma * v / errors.rows;
    }
    EXPECT_NEAR(Wall(errors).pixels(), flat, 0.05 * flat);
}

TEST(correlatedPixels, ofAFewCellsErrAsCells)
{
    test::GaussianSampler sampler(5);
    const Wall wall(noise(sampler, 1, {20, 10}));
    ASSERT_EQ(wall.plane.cells.size(), 2U);
    EXPECT_EQ(wall.pixels(), 100);
}

TEST(correlatedPixels, withoutNoiseAreAtLeastOne)
{
    const Wall wall(cv::Mat(240, 320, CV_32FC1, cv::Scalar(0)), 2);
    EXPECT_GE(wall.pixels(), 1);
    EXPECT_LT(wall.pixels(), 2);
}
}  // namespace pointplane
