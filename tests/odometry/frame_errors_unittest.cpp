// SPDX-License-Identifier: BSD-3-Clause
#include "frame_errors.h"

#include <cmath>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr double kFrame = 1.0 / 20;  // [s]

/** One view in a third of a second: the rate at which drift is what its parameters say. */
Eigen::Isometry3d motion(double distance = 0.15 * 3 * kFrame)
{
    return Eigen::Isometry3d(Eigen::Translation3d(0, distance, 0));
}

Sensitivity sensitivity(double points, double planes)
{
    Sensitivity out;
    out.points = points * Matrix12d::Identity();
    out.planes = planes * Matrix12d::Identity();
    return out;
}

JointCovariance::TParams params()
{
    JointCovariance::TParams out;
    out.noise = 0.5;
    out.drift = 4;
    out.driftSigma = 0.01;
    return out;
}

JointCovariance::Measurement errors(
    const Sensitivity& s, NoiseFactors residuals = {}, NoiseFactors disagreement = {})
{
    return frameErrors(s, residuals, disagreement, motion(), kFrame, params());
}
}  // namespace

TEST(frameErrors, byHand)
{
    // 0.15 of a view. Planes: noise 0.5 and 0.5 * 4 * 0.15; points: 0.1 and 54 times that.
    const JointCovariance::Measurement e = errors(sensitivity(1e-3, 2e-3));
    EXPECT_NEAR(e.noise(0, 0), 0.5 * (0.1 * 1e-3 + 2e-3), 1e-12);
    EXPECT_NEAR(e.noise(11, 11), e.noise(0, 0), 1e-12);
    EXPECT_NEAR(e.drift(0, 0), 0.15 * (2 * (54 * 1e-3 + 2e-3) + 1e-4), 1e-12);
    EXPECT_NEAR(e.drift(5, 5), 0.15 * (2 * (54 * 1e-3 + 2e-3) + 1e-4 / 16), 1e-12);
}

TEST(frameErrors, residualsAndDisagreementOfPointsTellTheirs)
{
    const Sensitivity s = sensitivity(1e-3, 0);
    const JointCovariance::Measurement one = errors(s), four = errors(s, {4, 1}, {3, 1});
    EXPECT_NEAR(four.noise(0, 0), 4 * one.noise(0, 0), 1e-12);
    const double common = 0.15 * 1e-4;
    EXPECT_NEAR(
        four.drift(0, 0) - std::pow(4, 2.5) * common,
        3 * std::pow(4, 1.9) * (one.drift(0, 0) - common),
        1e-12);
}

/** Many pixels average noise, but not that a surface is no plane. */
TEST(frameErrors, smallResidualsSayNothingAgainstErrorsInCommon)
{
    const Sensitivity s = sensitivity(1e-3, 2e-3);
    const Matrix6d small = errors(s, {1, 0.1}).drift;
    EXPECT_TRUE(small.isApprox(errors(s).drift, 1e-12));
    EXPECT_NEAR(
        errors(s, {1, 9}).drift(0, 0) - small(0, 0), 0.15 * 1e-4 * (std::sqrt(9.0) - 1), 1e-12);
}

/** What is assumed of planes before the first one is no measurement. */
TEST(frameErrors, featuresThatAFrameLacksSayNothing)
{
    EXPECT_EQ(errors(sensitivity(1e-3, 0), {1, 3}).drift, errors(sensitivity(1e-3, 0)).drift);
    EXPECT_EQ(errors(sensitivity(0, 1e-3), {3, 1}).drift, errors(sensitivity(0, 1e-3)).drift);
}

TEST(frameErrors, driftGrowsWithTheMotionAndMoreIfItIsFast)
{
    const auto drift = [](double distance, double dt)
    {
        return frameErrors(sensitivity(1e-3, 2e-3), {}, {}, motion(distance), dt, params())
            .drift(0, 0);
    };
    const double slow = drift(0.01, 0.1);
    EXPECT_EQ(drift(0, 0.1), 0);
    EXPECT_NEAR(drift(0.02, 0.2), 2 * slow, 1e-12);
    EXPECT_NEAR(drift(0.01, 0.01), std::pow(10, 0.25) * slow, 1e-12);
    EXPECT_EQ(drift(0.01, 1e-320), drift(0.01, 1e-3));  // stamps that cannot be true
}
}  // namespace pointplane
