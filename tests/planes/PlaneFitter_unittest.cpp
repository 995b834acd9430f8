// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneFitter.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <vector>

#include "matchers.h"
#include "synthetic_depth.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
const Eigen::Vector3d kTheta(0.12, -0.2, -0.55);

/** Rays of a window of the image, every 8th pixel. */
std::vector<Eigen::Vector3d> windowRays()
{
    const PinholeCamera camera = test::kinectCamera();
    std::vector<Eigen::Vector3d> out;
    for (int v = 60; v < 300; v += 8)
    {
        for (int u = 200; u < 400; u += 8)
        {
            out.push_back(test::pixelRay(camera, u, v));
        }
    }
    return out;
}

/** Points of kTheta with independent noise in inverse depth. */
std::vector<Eigen::Vector3d> noisyPoints(double sigma, test::GaussianSampler& sampler)
{
    std::vector<Eigen::Vector3d> out;
    for (const Eigen::Vector3d& ray : windowRays())
    {
        out.emplace_back(ray / (-kTheta.dot(ray) + sigma * sampler.normal()));
    }
    return out;
}

PlaneMoments momentsOfPoints(const std::vector<Eigen::Vector3d>& points)
{
    PlaneMoments m;
    for (const Eigen::Vector3d& P : points)
    {
        m.add(P.x() / P.z(), P.y() / P.z(), 1 / P.z());
    }
    return m;
}
}  // namespace

TEST(FitInverseDepth, covarianceByHand)
{
    // Rays (+-1, +-1, 1): sum r r^T = 4 I. Noise free: the sensor's sigma counts.
    PlaneMoments m;
    for (const double x : {-1.0, 1.0})
    {
        for (const double y : {-1.0, 1.0})
        {
            m.add(x, y, 0.5);
        }
    }
    const auto plane = fitInverseDepth(m, {0.01, 0.5});
    ASSERT_TRUE(plane);
    EXPECT_THAT(plane->theta_m, test::IsMatrixNear(Eigen::Vector3d(0, 0, -0.5), 1e-15));
    EXPECT_THAT(plane->cov_m, test::IsMatrixNear(0.25e-4 * Eigen::Matrix3d::Identity(), 1e-18));
}

TEST(FitInverseDepth, residualsLargerThanTheSensorsNoiseWiden)
{
    // As above, residuals +-0.1: sse 0.04, one degree of freedom.
    PlaneMoments m;
    m.add(-1, -1, 0.6);
    m.add(1, 1, 0.6);
    m.add(-1, 1, 0.4);
    m.add(1, -1, 0.4);
    const auto plane = fitInverseDepth(m, {0.01, 0.5});
    ASSERT_TRUE(plane);
    EXPECT_THAT(plane->cov_m, test::IsMatrixNear(0.01 * Eigen::Matrix3d::Identity(), 1e-15));
}

TEST(FitInverseDepth, covarianceIsThatOfMonteCarlo)
{
    const DepthNoise noise;
    test::GaussianSampler sampler(10);
    std::vector<Eigen::Vector3d> errors;
    double nees = 0;
    const int runs = 4000;
    for (int i = 0; i < runs; ++i)
    {
        const auto plane =
            fitInverseDepth(momentsOfPoints(noisyPoints(noise.sigmaInverseDepth, sampler)), noise);
        ASSERT_TRUE(plane);
        errors.emplace_back(kTheta - plane->theta_m);
        nees += errors.back().dot(plane->cov_m.inverse() * errors.back());
    }
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& ray : windowRays())
    {
        A += ray * ray.transpose();
    }
    const Eigen::Matrix3d expected =
        noise.sigmaInverseDepth * noise.sigmaInverseDepth * A.inverse();
    EXPECT_LT(test::whitenedDifference(test::sampleCovariance(errors), expected), 0.1);
    // chi^2(3 runs) / runs is 3 +- 0.12 (3 sigma); max(residual, sensor) widens by 2 %.
    EXPECT_NEAR(nees / runs, 3, 0.18);
}

/** Noise that is constant in the depth, weighted as CellGrid::weigh() does. */
TEST(FitInverseDepth, covarianceOfWeightedPixelsIsThatOfMonteCarlo)
{
    DepthNoise noise;
    noise.sigmaDepth = 0.01;
    noise.sigmaInverseDepth = 1e-3;
    const Eigen::Vector3d theta(1.5, 0, -0.5);  // from 1.2 m to 3.6 m away
    test::GaussianSampler sampler(11);
    double nees = 0;
    const int runs = 4000;
    for (int i = 0; i < runs; ++i)
    {
        PlaneMoments moments;
        for (const Eigen::Vector3d& ray : windowRays())
        {
            const double q = -theta.dot(ray);
            moments.add(
                ray.x(),
                ray.y(),
                q + std::sqrt(noise.inverseDepthVariance(q)) * sampler.normal(),
                noise.weight(q));
        }
        const auto plane = fitInverseDepth(moments, noise);
        ASSERT_TRUE(plane);
        const Eigen::Vector3d error = theta - plane->theta_m;
        nees += error.dot(plane->cov_m.inverse() * error);
    }
    EXPECT_NEAR(nees / runs, 3, 0.18);
}

TEST(FitInverseDepth, pixelsThatSpanNoPlaneHaveNone)
{
    PlaneMoments m;
    EXPECT_FALSE(fitInverseDepth(m, {}));
    for (int i = 0; i < 100; ++i)
    {
        m.add(0.01 * i, 0.02 * i, 0.5);
    }
    EXPECT_FALSE(fitInverseDepth(m, {}));
}

TEST(FitWeightedLeastSquares, byHand)
{
    // Four points of the plane z = 2: sigma_Z = 0.01 * 4, w = 625; A = w diag(2, 2, 16), b = -w (0,
    // 0, 8). A^-1 is in 1/mm^2.
    DepthNoise noise;
    noise.sigmaInverseDepth = 0.01;
    const auto plane =
        fitWeightedLeastSquares({{1, 0, 2}, {-1, 0, 2}, {0, 1, 2}, {0, -1, 2}}, noise);
    ASSERT_TRUE(plane);
    EXPECT_THAT(plane->theta_m, test::IsMatrixNear(Eigen::Vector3d(0, 0, -0.5), 1e-14));
    const Eigen::Vector3d cov(1e6 / 1250, 1e6 / 1250, 1e6 / 10000);
    EXPECT_THAT(plane->cov_m, test::IsMatrixNear(Eigen::Matrix3d(cov.asDiagonal()), 1e-9));
    const Plane hessian = hessianForm(plane->theta_m);
    EXPECT_THAT(hessian.n, test::IsMatrixNear(Eigen::Vector3d(0, 0, -1), 1e-14));
    EXPECT_NEAR(hessian.d, 2, 1e-13);
}

/** sigma_Z = 1.425e-6 Z^2, all lengths in millimetres, as the paper writes it. */
TEST(FitWeightedLeastSquares, isTheMinimumOfThePapersCost)
{
    test::GaussianSampler sampler(11);
    const DepthNoise noise;
    const auto points = noisyPoints(5e-3, sampler);
    const auto n = static_cast<Eigen::Index>(points.size());
    Eigen::MatrixXd rows(n, 3);
    Eigen::VectorXd ones(n);
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    for (Eigen::Index i = 0; i < n; ++i)
    {
        const Eigen::Vector3d P_mm = 1000 * points[static_cast<size_t>(i)];
        const double sigma_mm = 1.425e-6 * P_mm.z() * P_mm.z();
        rows.row(i) = P_mm.transpose() / sigma_mm;
        ones[i] = 1 / sigma_mm;
        A += P_mm * P_mm.transpose() / (sigma_mm * sigma_mm);
    }
    const auto plane = fitWeightedLeastSquares(points, noise);
    ASSERT_TRUE(plane);
    const Eigen::Vector3d expected = rows.colPivHouseholderQr().solve(-ones);  // [1/mm]
    EXPECT_THAT(plane->theta_m, test::IsMatrixNear(1000 * expected, 1e-10));
    EXPECT_LT(test::whitenedDifference(plane->cov_m, 1e6 * A.inverse()), 1e-9);
}

TEST(FitWeightedLeastSquares, pointsThatSpanNoPlaneHaveNone)
{
    const DepthNoise noise;
    EXPECT_FALSE(fitWeightedLeastSquares({}, noise));
    EXPECT_FALSE(fitWeightedLeastSquares({{0, 0, 1}, {1, 0, 1}}, noise));
    EXPECT_FALSE(fitWeightedLeastSquares({{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}}, noise));
    // A plane through the camera has no theta_m.
    EXPECT_FALSE(fitWeightedLeastSquares({{0, 0, 1}, {1, 0, 1}, {1, 0, 2}, {0, 0, 3}}, noise));
}

class RansacTest : public testing::Test
{
 protected:
    RansacTest()
    {
        test::GaussianSampler sampler(12);
        points = noisyPoints(noise.sigmaInverseDepth, sampler);
        for (size_t i = 0; i < points.size(); i += 3)
        {
            points[i] *= 1 + 0.05 * (1 + sampler.uniform(0, 3));  // 5 to 20 % farther
            ++numOutliers;
        }
    }
    [[nodiscard]] bool isOutlier(const Eigen::Vector3d& P) const
    {
        return std::abs(1 / P.z() + kTheta.dot(P / P.z())) > 6 * noise.sigmaInverseDepth;
    }
    [[nodiscard]] std::vector<Eigen::Vector3d> inliers() const
    {
        std::vector<Eigen::Vector3d> out;
        for (const std::size_t i : ransacInliers(points, noise, 3, 50, 1))
        {
            out.push_back(points[i]);
        }
        return out;
    }
    DepthNoise noise;
    std::vector<Eigen::Vector3d> points;
    std::ptrdiff_t numOutliers{0};
};

TEST_F(RansacTest, removesAThirdOfOutliers)
{
    const auto kept = inliers();
    EXPECT_EQ(
        std::count_if(kept.begin(), kept.end(), [&](const auto& P) { return isOutlier(P); }), 0);
    const auto numGood = static_cast<std::ptrdiff_t>(points.size()) - numOutliers;
    EXPECT_GT(static_cast<std::ptrdiff_t>(kept.size()), numGood * 9 / 10);
    const auto all = fitWeightedLeastSquares(points, noise);
    const auto filtered = fitWeightedLeastSquares(kept, noise);
    ASSERT_TRUE(all && filtered);
    EXPECT_GT((all->theta_m - kTheta).norm(), 0.01);
    EXPECT_LT((filtered->theta_m - kTheta).norm(), 1e-3);
}

TEST_F(RansacTest, sameSeedGivesTheSameInliers)
{
    EXPECT_EQ(ransacInliers(points, noise, 3, 50, 1), ransacInliers(points, noise, 3, 50, 1));
}

TEST_F(RansacTest, keepsAllWhereThereIsNothingToChoose)
{
    EXPECT_EQ(ransacInliers({{0, 0, 1}, {1, 0, 1}}, noise, 3, 50, 1).size(), 2U);
    EXPECT_TRUE(ransacInliers({}, noise, 3, 50, 1).empty());
    const std::vector<Eigen::Vector3d> same(10, Eigen::Vector3d(0.1, 0.2, 1));
    EXPECT_EQ(ransacInliers(same, noise, 3, 50, 1).size(), 10U);
}
}  // namespace pointplane
