// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/frame_errors.h"

#include <cmath>

#include "uncertainty/views.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Features of the given variances, all at the distance. */
struct Solved
{
    PoseEstimate estimate;
    Sensitivity of;
};

Solved estimate(double points, double planes, double distance = 1)
{
    Solved solved;
    solved.of.points = points * Matrix12d::Identity();
    solved.of.planes = planes * Matrix12d::Identity();
    PoseEstimate& out = solved.estimate;
    out.infoPoints.setIdentity();
    out.infoPoints.bottomRightCorner<3, 3>() *= 2 * distance * distance;
    return solved;
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
    const Solved& e, NoiseFactors white = {}, NoiseFactors drift = {}, double views = 0.15)
{
    return frameErrors(e.estimate, e.of, {white, drift}, views, params());
}
}  // namespace

TEST(frameErrors, byHand)
{
    // 0.15 of a view. Noise 0.5 of both; drift 4 times the planes', 33 times that of points.
    const JointCovariance::Measurement e = errors(estimate(1e-3, 2e-3));
    EXPECT_NEAR(e.noise(0, 0), 0.5 * 3e-3, 1e-12);
    EXPECT_NEAR(e.noise(11, 11), e.noise(0, 0), 1e-12);
    EXPECT_NEAR(e.drift(0, 0), 0.15 * (4 * (33 * 1e-3 + 2e-3) + 1e-4), 1e-12);
    EXPECT_NEAR(e.drift(5, 5), 0.15 * (4 * (33 * 1e-3 + 2e-3) + 1e-4 / 4), 1e-12);
}

TEST(frameErrors, eachKindHasItsLevels)
{
    const Solved e = estimate(1e-3, 2e-3);
    EXPECT_NEAR(errors(e, {3, 5}).noise(0, 0), 0.5 * (3 * 1e-3 + 5 * 2e-3), 1e-12);
    EXPECT_NEAR(
        errors(e, {}, {3, 5}).drift(0, 0),
        0.15 * (4 * (3 * 33 * 1e-3 + 5 * 2e-3) + std::pow(3, 1.25) * std::pow(5, 0.85) * 1e-4),
        1e-12);
}

/** Depth errs with the square of the distance, pixels with the distance; so does what a rotation
 * does. */
TEST(frameErrors, whatIsInCommonGrowsWithTheDistance)
{
    const auto common = [](double distance) { return errors(estimate(0, 0, distance)).drift; };
    EXPECT_NEAR(common(3)(0, 0), 27 * common(1)(0, 0), 1e-12);
    EXPECT_NEAR(common(3)(5, 5), 9 * common(1)(5, 5), 1e-12);
    Solved nothing = estimate(0, 0);
    nothing.estimate.infoPoints.setZero();
    EXPECT_TRUE(errors(nothing).drift.isApprox(common(1)));
}

/** What is assumed of planes before the first one is no measurement. */
TEST(frameErrors, featuresThatAFrameLacksSayNothing)
{
    EXPECT_EQ(errors(estimate(1e-3, 0), {}, {1, 3}).drift, errors(estimate(1e-3, 0)).drift);
    EXPECT_EQ(errors(estimate(0, 1e-3), {}, {3, 1}).drift, errors(estimate(0, 1e-3)).drift);
}

TEST(frameErrors, driftGrowsWithTheMotion)
{
    const Solved e = estimate(1e-3, 2e-3);
    EXPECT_EQ(errors(e, {}, {}, 0).drift.norm(), 0);
    EXPECT_TRUE(errors(e, {}, {}, 0.3).drift.isApprox(2 * errors(e).drift));
    EXPECT_EQ(errors(e, {}, {}, 0.3).noise, errors(e).noise);
}

TEST(numViews, isOneForAnotherViewOfTheScene)
{
    const Eigen::AngleAxisd turn(10 * M_PI / 180, Eigen::Vector3d::UnitY());
    EXPECT_NEAR(numViews(Eigen::Isometry3d(Eigen::Translation3d(0, 0.15, 0))), 1, 1e-12);
    EXPECT_NEAR(numViews(Eigen::Isometry3d(turn)), 1, 1e-12);
    EXPECT_NEAR(numViews(Eigen::Translation3d(0.15, 0, 0) * Eigen::Isometry3d(turn)), 2, 1e-12);
    EXPECT_EQ(numViews(Eigen::Isometry3d::Identity()), 0);
}
}  // namespace pointplane
