// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/exposure_errors.h>

#include "matchers.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** An estimate that goes by the points for some part, and by the planes for the rest. */
Sensitivity followsPoints(double part)
{
    Sensitivity out;
    out.pointsMoved.topRows<6>() = -part * Matrix6d::Identity();
    out.planesMoved.topRows<6>() = -(1 - part) * Matrix6d::Identity();
    return out;
}

Vector6d acceleration2()
{
    Vector6d out;
    out << 4, 4, 4, 25, 25, 25;  // 2 m/s^2, 5 rad/s^2
    return out;
}
}  // namespace

TEST(AccelerationWhileExposed, ofAGlobalShutterIsThatOfTheDelay)
{
    // 2 m/s^2 and 5 rad/s^2 over 0.02 s: 0.4 mm and 1 mrad.
    const Matrix12d cov =
        accelerationWhileExposed(followsPoints(0), {0, 0, -0.02}, acceleration2());
    EXPECT_NEAR(cov(0, 0), 0.0004 * 0.0004, 1e-15);
    EXPECT_NEAR(cov(5, 5), 0.001 * 0.001, 1e-15);
    EXPECT_EQ(cov(0, 1), 0);
    EXPECT_TRUE(
        accelerationWhileExposed(followsPoints(1), {0, 0, -0.02}, acceleration2()).isZero(0))
        << "points are where the colour image shows them";
}

TEST(AccelerationWhileExposed, isTheMeanOverTheRows)
{
    const double readout = 0.03;
    constexpr int kRows = 10000;
    double mean_m = 0;
    for (int row = 0; row < kRows; ++row)
    {
        const double s = ((row + 0.5) / kRows - 0.5) * readout;
        mean_m += 2 * s * s / 2 / kRows;
    }
    const Matrix12d cov =
        accelerationWhileExposed(followsPoints(1), {readout, 0, 0}, acceleration2());
    EXPECT_NEAR(cov(1, 1), mean_m * mean_m, 1e-6 * mean_m * mean_m);
}

TEST(AccelerationWhileExposed, pointsAndPlanesErrByTheSameAcceleration)
{
    const ShutterModel shutter{0.03, 0.03, 0};
    EXPECT_THAT(
        accelerationWhileExposed(followsPoints(0.5), shutter, acceleration2()),
        test::IsMatrixNear(
            accelerationWhileExposed(followsPoints(1), shutter, acceleration2()), 1e-18));
}
}  // namespace pointplane
