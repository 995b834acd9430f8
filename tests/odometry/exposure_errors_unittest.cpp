// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/exposure_errors.h"

#include <cmath>

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

/** How far an acceleration of 2 m/s^2 moves a row of an image, on average [m]. */
double meanOverRows(double delay, double readout)
{
    constexpr int kRows = 10000;
    double out = 0;
    for (int row = 0; row < kRows; ++row)
    {
        const double s = delay + ((row + 0.5) / kRows - 0.5) * readout;
        out += 2 * s * s / 2 / kRows;
    }
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
    const auto sigma = [](double points, const ShutterModel& shutter)
    {
        return std::sqrt(
            accelerationWhileExposed(followsPoints(points), shutter, acceleration2())(1, 1));
    };
    EXPECT_NEAR(sigma(1, {0.03, 0.01, -0.02}), meanOverRows(0, 0.03), 1e-9) << "of colour";
    EXPECT_NEAR(sigma(0, {0.01, 0.03, -0.02}), meanOverRows(-0.02, 0.03), 1e-9) << "of depth";
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
