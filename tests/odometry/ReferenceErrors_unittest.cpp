// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/ReferenceErrors.h>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Variance of a reference's error, over driftPerView(), after going through views along a line on
 * which it stands at 0. */
double varianceAfter(const std::vector<double>& places)
{
    double out = 0, at = 0;
    for (const double place : places)
    {
        const JointCovariance::DriftStep step =
            driftStep(std::abs(at), std::abs(place), std::abs(place - at));
        out = step.kept * step.kept * out + step.gained;
        at = place;
    }
    return out;
}

constexpr double kReach = 4;

double variogram(double views) { return kReach * (1 - std::exp(-views / kReach)); }
}  // namespace

TEST(viewsBetween, isOneForAnotherViewOfTheScene)
{
    const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
    const Eigen::AngleAxisd turn(2, Eigen::Vector3d::UnitY());
    EXPECT_EQ(viewsBetween(still, 0), 0);
    EXPECT_NEAR(viewsBetween(Eigen::Isometry3d(Eigen::Translation3d(0, 0.15, 0)), 0), 1, 1e-12);
    EXPECT_NEAR(viewsBetween(Eigen::Isometry3d(turn), 0), 1, 1e-12);
    EXPECT_NEAR(viewsBetween(still, 1), 1, 1e-12);
    EXPECT_NEAR(
        viewsBetween(Eigen::Translation3d(0.15, 0, 0) * Eigen::Isometry3d(turn), 1), 3, 1e-12);
}

/** However it got there, on a line the error has the variance of the field. */
TEST(driftStep, dependsOnThePlaceNotOnTheWay)
{
    EXPECT_NEAR(varianceAfter({0.3}), variogram(0.3), 1e-12);
    EXPECT_NEAR(varianceAfter({0.1, 0.2, 0.3}), variogram(0.3), 1e-12);
    EXPECT_NEAR(varianceAfter({1, 3, 2, 0.5, 0.3}), variogram(0.3), 1e-12);
    EXPECT_NEAR(varianceAfter({1, 3, -2, 0.5, 0.3}), variogram(0.3), 1e-12);
}

TEST(driftStep, vanishesWhenTheCameraReturns)
{
    EXPECT_NEAR(varianceAfter({1, 2, 1, 0}), 0, 1e-12);
    EXPECT_NEAR(varianceAfter({0, 0, 0}), 0, 1e-12);
}

TEST(driftStep, isARandomWalkAtFirstAndSaturates)
{
    EXPECT_NEAR(varianceAfter({0.01, 0.02}), 0.02, 1e-4);
    EXPECT_NEAR(driftStep(2, 0.3, 1.9).whole, variogram(0.3), 1e-12);
    EXPECT_NEAR(varianceAfter({20, 40, 60}), kReach, 1e-3);
    const JointCovariance::DriftStep away = driftStep(100, 110, 10);
    EXPECT_NEAR(away.gained, kReach * (1 - away.kept * away.kept), 1e-6);
}

TEST(driftPerView, byHand)
{
    // Features 2 m away: a rotation moves them by 2 m / rad, in two of three directions.
    Matrix6d information = Matrix6d::Identity();
    information.bottomRightCorner<3, 3>() *= 2 * 2 * 2;
    const Matrix6d drift = driftPerView(0.01, information);
    EXPECT_NEAR(drift(0, 0), 0.02 * 0.02, 1e-15);
    EXPECT_NEAR(drift(5, 5), 0.005 * 0.005, 1e-15);
    EXPECT_NEAR(drift(1, 4), 0, 1e-15);
    EXPECT_NEAR(driftPerView(0.01, Matrix6d::Zero())(0, 0), 1e-4, 1e-15) << "of nothing, 1 m";
}
}  // namespace pointplane
