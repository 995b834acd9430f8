// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/view_errors.h"

#include <Eigen/Core>

#include <cmath>
#include <vector>

#include "linear_algebra.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
Eigen::Isometry3d view(double x, double angle)
{
    return Eigen::Translation3d(x, 0, 0) * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY());
}
}  // namespace

TEST(viewCorrelation, byHand)
{
    EXPECT_EQ(viewCorrelation(view(0, 0), 2, 1), 1);
    EXPECT_NEAR(viewCorrelation(view(0.6, 0), 0.6, 1), std::exp(-1), 1e-12);
    EXPECT_NEAR(viewCorrelation(view(-0.6, 0), 0.6, 1), std::exp(-1), 1e-12);
    EXPECT_NEAR(viewCorrelation(view(0.6, 0), 6, 1), std::exp(-0.1), 1e-12) << "of a far scene";
    EXPECT_NEAR(viewCorrelation(view(0, -1), 2, 1), std::exp(-1), 1e-12);
    EXPECT_NEAR(viewCorrelation(view(1, 0.5), 2, 1), std::exp(-1), 1e-12);
    EXPECT_NEAR(viewCorrelation(view(0, 1), 2, 2), std::exp(-0.5), 1e-12) << "half of a wide view";
    EXPECT_NEAR(viewCorrelation(view(1, 1), 1, 2), std::exp(-1), 1e-12);
}

TEST(planeViewCorrelation, byHand)
{
    EXPECT_EQ(planeViewCorrelation(view(0, 0), 2, 1), 1);
    EXPECT_NEAR(planeViewCorrelation(view(0.6, 0), 2, 0.9), std::exp(-1), 1e-12);
    EXPECT_NEAR(planeViewCorrelation(view(0.3, 0.15), 2, 0.9), std::exp(-1), 1e-12);
}

/** Of any places, in any order: else it would be no correlation. */
TEST(viewCorrelation, isPositiveDefinite)
{
    const std::vector<std::pair<double, double>> views{
        {0, 0}, {0.1, 0.03}, {0.5, 0.4}, {0.1, 1}, {-2, 3}, {0, -1}};
    const auto n = static_cast<Eigen::Index>(views.size());
    Eigen::MatrixXd C(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
    {
        for (Eigen::Index k = 0; k < n; ++k)
        {
            const auto &a = views[static_cast<size_t>(i)], &b = views[static_cast<size_t>(k)];
            C(i, k) =
                viewCorrelation(view(a.first, a.second).inverse() * view(b.first, b.second), 2, 1);
        }
    }
    EXPECT_GT(test::symmetricEigen(C).values.minCoeff(), 0.01);
}

TEST(featureDistance, isWhereATurnMovesFeaturesAsFarAsATranslation)
{
    Matrix6d information = Matrix6d::Identity();
    information.bottomRightCorner<3, 3>() *= 8;  // as of features 2 m away
    EXPECT_NEAR(featureDistance(information), 2, 1e-12);
    EXPECT_NEAR(featureDistance(100 * information), 2, 1e-12);
    EXPECT_NEAR(featureDistance(Matrix6d::Zero()), 1, 1e-12) << "of nothing";
}

TEST(viewSigma, byHand)
{
    const Vector12d sigma = viewSigma(0.01, 2, {0.03, 0, 0});
    EXPECT_NEAR(sigma[0], 0.02, 1e-12);
    EXPECT_NEAR(sigma[2], 0.02, 1e-12);
    EXPECT_NEAR(sigma[5], 0.01, 1e-12);
    // Rows are exposed within 30 ms: 8.66 ms of standard deviation.
    EXPECT_NEAR(sigma[6], 0.02 / 0.00866025, 1e-5);
    EXPECT_NEAR(sigma[11], 0.01 / 0.00866025, 1e-5);
    EXPECT_TRUE(viewSigma(0.01, 2, {-0.03, 0, 0}).isApprox(sigma)) << "from below";
}

/** A camera that exposes all rows at once, and depth later, errs by no more than its pose between
 * the two: the velocity times the delay. */
TEST(viewSigma, ofImagesThatAreExposedOneAfterTheOther)
{
    const Vector12d sigma = viewSigma(0.01, 1, {0, 0, -0.02});
    EXPECT_NEAR(sigma[11] * 0.02, 2 * sigma[5], 1e-12) << "half before, half after their mean";
    EXPECT_LT(viewSigma(0.01, 1, {0.03, 0, -0.02})[11], sigma[11]);
    EXPECT_TRUE(viewSigma(0.01, 1, {0, 0, 0}).tail<6>().isZero(0)) << "all at once";
}
}  // namespace pointplane
