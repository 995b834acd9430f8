// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneMoments.h>

#include <Eigen/QR>

#include <vector>

#include "matchers.h"
#include "monte_carlo.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
struct Pixel
{
    double x, y, q;
};

PlaneMoments momentsOf(const std::vector<Pixel>& pixels)
{
    PlaneMoments m;
    for (const Pixel& p : pixels)
    {
        m.add(p.x, p.y, p.q);
    }
    return m;
}

/** Pixels of a plane over a window of rays, with noise. */
std::vector<Pixel> pixelsOf(
    const Eigen::Vector3d& theta, int n, double sigma, test::GaussianSampler& sampler)
{
    std::vector<Pixel> out;
    for (int i = 0; i < n; ++i)
    {
        const double x = sampler.uniform(-0.5, 0.3), y = sampler.uniform(-0.2, 0.4);
        out.push_back({x, y, -theta.dot(Eigen::Vector3d(x, y, 1)) + sigma * sampler.normal()});
    }
    return out;
}
}  // namespace

TEST(PlaneMoments, addSumsWeightedProducts)
{
    PlaneMoments m;
    m.add(0.5, -0.25, 2, 3);
    m.add(-1, 2, 0.5);
    EXPECT_DOUBLE_EQ(m.n, 4);
    EXPECT_DOUBLE_EQ(m.x, 1.5 - 1);
    EXPECT_DOUBLE_EQ(m.y, -0.75 + 2);
    EXPECT_DOUBLE_EQ(m.xx, 0.75 + 1);
    EXPECT_DOUBLE_EQ(m.xy, -0.375 - 2);
    EXPECT_DOUBLE_EQ(m.yy, 0.1875 + 4);
    EXPECT_DOUBLE_EQ(m.q, 6 + 0.5);
    EXPECT_DOUBLE_EQ(m.xq, 3 - 0.5);
    EXPECT_DOUBLE_EQ(m.yq, -1.5 + 1);
    EXPECT_DOUBLE_EQ(m.qq, 12 + 0.25);
    Eigen::Matrix3d A;
    A << 1.75, -2.375, 0.5, -2.375, 4.1875, 1.25, 0.5, 1.25, 4;
    EXPECT_THAT(m.rayMatrix(), test::IsMatrixNear(A, 1e-15));
}

TEST(PlaneMoments, fitsThreePixelsByHand)
{
    // q = 1 + x - 2 y through (0, 0), (1, 0), (0, 1): theta = -(1, -2, 1).
    const auto fit = fitPlane(momentsOf({{0, 0, 1}, {1, 0, 2}, {0, 1, -1}}));
    ASSERT_TRUE(fit);
    EXPECT_THAT(fit->theta_m, test::IsMatrixNear(Eigen::Vector3d(-1, 2, -1), 1e-14));
    EXPECT_NEAR(fit->sse, 0, 1e-15);
    // A fourth pixel at (1, 1) that is off by 4: residuals +-1 all around.
    const auto off = fitPlane(momentsOf({{0, 0, 1}, {1, 0, 2}, {0, 1, -1}, {1, 1, 4}}));
    ASSERT_TRUE(off);
    EXPECT_NEAR(off->sse, 4, 1e-12);
}

TEST(PlaneMoments, momentsOfPartsAddUp)
{
    test::GaussianSampler sampler(1);
    const auto pixels = pixelsOf({0.1, -0.2, -0.5}, 200, 0.01, sampler);
    const std::vector<Pixel> a(pixels.begin(), pixels.begin() + 77),
        b(pixels.begin() + 77, pixels.end());
    const auto whole = fitPlane(momentsOf(pixels));
    const auto sum = fitPlane(momentsOf(a) + momentsOf(b));
    ASSERT_TRUE(whole && sum);
    EXPECT_THAT(sum->theta_m, test::IsMatrixNear(whole->theta_m, 1e-13));
    EXPECT_NEAR(sum->sse, whole->sse, 1e-12);
}

TEST(PlaneMoments, fitIsDirectLeastSquares)
{
    test::GaussianSampler sampler(2);
    const auto pixels = pixelsOf({0.3, 0.1, -0.7}, 150, 0.02, sampler);
    Eigen::MatrixXd R(150, 3);
    Eigen::VectorXd q(150);
    for (int i = 0; i < 150; ++i)
    {
        const Pixel& p = pixels[static_cast<size_t>(i)];
        R.row(i) << p.x, p.y, 1;
        q[i] = p.q;
    }
    const Eigen::Vector3d expected = R.colPivHouseholderQr().solve(-q);
    const auto fit = fitPlane(momentsOf(pixels));
    ASSERT_TRUE(fit);
    EXPECT_THAT(fit->theta_m, test::IsMatrixNear(expected, 1e-12));
    EXPECT_NEAR(fit->sse, (R * expected + q).squaredNorm(), 1e-12);
}

TEST(PlaneMoments, weightIsRepetition)
{
    PlaneMoments repeated = momentsOf({{0, 0, 1}, {1, 0, 2}, {0, 1, 1.5}, {1, 1, 1}, {1, 1, 1}});
    PlaneMoments weighted = momentsOf({{0, 0, 1}, {1, 0, 2}, {0, 1, 1.5}});
    weighted.add(1, 1, 1, 2);
    EXPECT_THAT(
        fitPlane(weighted)->theta_m, test::IsMatrixNear(fitPlane(repeated)->theta_m, 1e-14));
}

TEST(PlaneMoments, exactWithoutNoiseInASmallWindowFarFromTheCentre)
{
    // A 10 x 10 cell in the image corner: rays that differ by 1/50 only.
    const Eigen::Vector3d theta(0.4, -0.3, -1.1);
    PlaneMoments m;
    for (int v = 0; v < 10; ++v)
    {
        for (int u = 0; u < 10; ++u)
        {
            const Eigen::Vector3d ray((u + 300) / 525.0, (v + 220) / 525.0, 1);
            m.add(ray.x(), ray.y(), -theta.dot(ray));
        }
    }
    const auto fit = fitPlane(m);
    ASSERT_TRUE(fit);
    EXPECT_THAT(fit->theta_m, test::IsMatrixNear(theta, 1e-9));
    EXPECT_LT(fit->sse, 1e-12);
    EXPECT_GE(fit->sse, 0);
}

TEST(PlaneMoments, pixelsThatSpanNoPlaneHaveNoFit)
{
    EXPECT_FALSE(fitPlane(PlaneMoments{}));
    EXPECT_FALSE(fitPlane(momentsOf({{0, 0, 1}, {1, 0, 1}})));
    EXPECT_FALSE(fitPlane(momentsOf({{0.1, 0.2, 1}, {0.1, 0.2, 1}, {0.1, 0.2, 2}})));
    EXPECT_FALSE(fitPlane(momentsOf({{0, 0, 1}, {1, 1, 2}, {2, 2, 1}, {3, 3, 7}})));
}
}  // namespace pointplane
