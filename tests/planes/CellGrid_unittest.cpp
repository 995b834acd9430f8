// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/CellGrid.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "synthetic_depth.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Moments of a cell summed pixel by pixel in double precision. */
PlaneMoments bruteForce(const cv::Mat& depth, const PinholeCamera& camera, int size, int c, int r)
{
    PlaneMoments out;
    for (int v = r * size; v < (r + 1) * size; ++v)
    {
        for (int u = c * size; u < (c + 1) * size; ++u)
        {
            const double z = static_cast<double>(depth.at<float>(v, u));
            if (z > 0 && std::isfinite(z))
            {
                const Eigen::Vector3d ray = test::pixelRay(camera, u, v);
                out.add(ray.x(), ray.y(), 1 / z);
            }
        }
    }
    return out;
}

void expectNear(const PlaneMoments& a, const PlaneMoments& b)
{
    // The library holds 1/Z in single precision: 6e-8 of it.
    const double tolerance = 1e-6 * std::max(1.0, b.n);
    EXPECT_EQ(a.n, b.n);
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.xx, b.xx, tolerance);
    EXPECT_NEAR(a.xy, b.xy, tolerance);
    EXPECT_NEAR(a.yy, b.yy, tolerance);
    EXPECT_NEAR(a.q, b.q, tolerance * std::max(1.0, b.q / std::max(1.0, b.n)));
    EXPECT_NEAR(a.xq, b.xq, tolerance * std::max(1.0, b.q / std::max(1.0, b.n)));
    EXPECT_NEAR(a.yq, b.yq, tolerance * std::max(1.0, b.q / std::max(1.0, b.n)));
    EXPECT_NEAR(a.qq, b.qq, tolerance * std::max(1.0, b.qq / std::max(1.0, b.n)));
}

/** A corner with noise and pixels of every kind of nonsense. */
cv::Mat damagedDepth(const PinholeCamera& camera)
{
    cv::Mat depth = test::renderRoom(camera, test::cornerThetas());
    test::GaussianSampler sampler(3);
    test::addInverseDepthNoise(depth, 1.4e-3, sampler);
    const float nonsense[] = {
        test::kNoDepth,
        0.F,
        -1.F,
        std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity(),
        1e-30F,
        1e30F,
        std::numeric_limits<float>::denorm_min()};
    for (int i = 0; i < depth.rows * depth.cols / 5; ++i)
    {
        const int u = static_cast<int>(sampler.uniform(0, depth.cols));
        const int v = static_cast<int>(sampler.uniform(0, depth.rows));
        depth.at<float>(v, u) = nonsense[i % 8];
    }
    depth(cv::Rect(20, 20, 25, 25)).setTo(test::kNoDepth);
    return depth;
}
}  // namespace

TEST(CellGrid, equalsBruteForce)
{
    for (const double fySign : {1.0, -1.0})
    {
        for (const int size : {4, 7, 10, 20})
        {
            const PinholeCamera camera = test::kinectCamera(163, 121, fySign);
            cv::Mat depth = damagedDepth(camera);
            // LatestImages leaves out what is nearer; its square would not be a float.
            depth.setTo(std::numeric_limits<float>::quiet_NaN(), depth < 1e-3);
            CellGrid grid;
            grid.compute(depth, camera, size);
            ASSERT_EQ(grid.cols, 163 / size);
            ASSERT_EQ(grid.rows, 121 / size);
            ASSERT_EQ(grid.moments.size(), static_cast<size_t>(grid.cols * grid.rows));
            for (int r = 0; r < grid.rows; ++r)
            {
                for (int c = 0; c < grid.cols; ++c)
                {
                    SCOPED_TRACE(testing::Message() << "cell " << c << "," << r << " of " << size);
                    expectNear(
                        grid.moments[static_cast<size_t>(r * grid.cols + c)],
                        bruteForce(depth, camera, size, c, r));
                }
            }
        }
    }
}

/** Residuals are a millionth of the sums that they come from: single precision must not eat them.
 */
TEST(CellGrid, residualsOfNearCellsSurvive)
{
    const PinholeCamera camera = test::kinectCamera();
    cv::Mat depth = test::renderRoom(camera, {test::thetaThrough({0, 0, 0.5}, {0.3, 0.2, -1})});
    test::GaussianSampler sampler(4);
    test::addInverseDepthNoise(depth, 1e-3, sampler);
    CellGrid grid;
    grid.compute(depth, camera, 10);
    for (const int cell : {0, 63, 1000, 3071})
    {
        const auto fit = fitPlane(grid.moments[static_cast<size_t>(cell)]);
        const auto expected =
            fitPlane(bruteForce(depth, camera, 10, cell % grid.cols, cell / grid.cols));
        ASSERT_TRUE(fit && expected);
        EXPECT_NEAR(fit->sse, expected->sse, 0.01 * expected->sse);
    }
}

TEST(CellGrid, allMissingAndTooSmallImages)
{
    const PinholeCamera camera = test::kinectCamera(64, 48);
    CellGrid grid;
    grid.compute(cv::Mat(48, 64, CV_32FC1, cv::Scalar(test::kNoDepth)), camera, 10);
    for (const PlaneMoments& m : grid.moments)
    {
        EXPECT_EQ(m.n, 0);
        EXPECT_EQ(m.qq, 0);
    }
    grid.compute(cv::Mat(1, 1, CV_32FC1, cv::Scalar(1)), camera, 10);
    EXPECT_TRUE(grid.moments.empty());
}

TEST(CellGrid, refusesWrongInput)
{
    CellGrid grid;
    const PinholeCamera camera = test::kinectCamera(64, 48);
    EXPECT_THROW(grid.compute(cv::Mat(48, 64, CV_16UC1), camera, 10), std::invalid_argument);
    EXPECT_THROW(grid.compute(cv::Mat(48, 64, CV_32FC1), camera, 1), std::invalid_argument);
}
}  // namespace pointplane
