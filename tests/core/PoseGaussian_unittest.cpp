// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/PoseGaussian.h>
#include <pointplane/core/se3.h>

#include "matchers.h"
#include "monte_carlo.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

namespace
{
constexpr int kSamples = 20000;

/** A motion of tens of degrees with sigmas of about 1 cm and 1 deg. */
PoseGaussian randomPose(GaussianSampler& random)
{
    Vector6d xi = random.vector<6>();
    xi.tail<3>() *= 0.5;
    return {se3Exp(xi), random.covariance<6>(1e-5, 3e-4)};
}

Eigen::Isometry3d draw(GaussianSampler& random, const PoseGaussian& pose)
{
    return se3Exp(random.sample(pose.cov)) * pose.mean;
}
}  // namespace

TEST(PoseGaussian, composeByHand)
{
    // b is one metre ahead of a; c turns in b about z with sigma 0.1 rad: seen from a, the lever
    // arm of 1 m does not move c (it turns in place), so its left tangent has rho = t x omega.
    PoseGaussian T_a_b, T_b_c;
    T_a_b.mean.translation() << 1, 0, 0;
    T_b_c.cov(5, 5) = 0.01;
    const PoseGaussian T_a_c = compose(T_a_b, T_b_c);
    Matrix6d expected = Matrix6d::Zero();
    expected(5, 5) = 0.01;
    expected(1, 1) = 0.01;
    expected(1, 5) = expected(5, 1) = -0.01;
    EXPECT_THAT(T_a_c.cov, IsMatrixNear(expected, 1e-16));
    EXPECT_THAT(T_a_c.mean, IsNearPose(T_a_b.mean, 0.0, 0.0));
}

TEST(PoseGaussian, composeMatchesMonteCarlo)
{
    GaussianSampler random(11);
    const PoseGaussian T_a_b = randomPose(random), T_b_c = randomPose(random);
    const PoseGaussian T_a_c = compose(T_a_b, T_b_c);
    std::vector<Vector6d> errors;
    for (int i = 0; i < kSamples; ++i)
    {
        errors.push_back(leftError(draw(random, T_a_b) * draw(random, T_b_c), T_a_c.mean));
    }
    EXPECT_LT(whitenedDifference(sampleCovariance(errors), T_a_c.cov), 0.07);
}

TEST(PoseGaussian, inverseMatchesMonteCarlo)
{
    GaussianSampler random(12);
    const PoseGaussian T_a_b = randomPose(random);
    const PoseGaussian T_b_a = inverse(T_a_b);
    std::vector<Vector6d> errors;
    for (int i = 0; i < kSamples; ++i)
    {
        errors.push_back(leftError(draw(random, T_a_b).inverse(), T_b_a.mean));
    }
    EXPECT_LT(whitenedDifference(sampleCovariance(errors), T_b_a.cov), 0.07);
}

TEST(PoseGaussian, changeFrameMatchesMonteCarlo)
{
    GaussianSampler random(13);
    const PoseGaussian cameraMotion = randomPose(random);
    const Eigen::Isometry3d T_robot_camera = randomPose(random).mean;
    const PoseGaussian robotMotion = changeFrame(T_robot_camera, cameraMotion);
    EXPECT_THAT(
        robotMotion.mean * T_robot_camera,
        IsNearPose(T_robot_camera * cameraMotion.mean, 1e-14, 1e-14));
    std::vector<Vector6d> errors;
    for (int i = 0; i < kSamples; ++i)
    {
        errors.push_back(leftError(
            T_robot_camera * draw(random, cameraMotion) * T_robot_camera.inverse(),
            robotMotion.mean));
    }
    EXPECT_LT(whitenedDifference(sampleCovariance(errors), robotMotion.cov), 0.07);
}

TEST(PoseGaussian, inverseOfInverseAndAssociativity)
{
    GaussianSampler random(14);
    const PoseGaussian a = randomPose(random), b = randomPose(random), c = randomPose(random);
    const PoseGaussian twice = inverse(inverse(a));
    EXPECT_THAT(twice.mean, IsNearPose(a.mean, 1e-14, 1e-14));
    EXPECT_THAT(twice.cov, IsMatrixNear(a.cov, 1e-17));
    const PoseGaussian left = compose(compose(a, b), c), right = compose(a, compose(b, c));
    EXPECT_THAT(left.mean, IsNearPose(right.mean, 1e-14, 1e-14));
    EXPECT_THAT(left.cov, IsMatrixNear(right.cov, 1e-16));
}

TEST(PoseGaussian, changeFrameCommutesWithCompose)
{
    GaussianSampler random(15);
    const PoseGaussian a = randomPose(random), b = randomPose(random);
    const Eigen::Isometry3d T_s_c = randomPose(random).mean;
    const PoseGaussian inside = changeFrame(T_s_c, compose(a, b));
    const PoseGaussian outside = compose(changeFrame(T_s_c, a), changeFrame(T_s_c, b));
    EXPECT_THAT(inside.mean, IsNearPose(outside.mean, 1e-13, 1e-13));
    EXPECT_THAT(inside.cov, IsMatrixNear(outside.cov, 1e-15));
}

TEST(PoseGaussian, staysARotationOverHours)
{
    // 30 Hz for three hours.
    PoseGaussian step;
    step.mean = se3Exp((Vector6d() << 0.01, 0, 0.003, 0.002, -0.01, 0.003).finished());
    PoseGaussian pose;
    for (int i = 0; i < 324000; ++i)
    {
        pose = compose(pose, step);
    }
    EXPECT_THAT(
        (pose.mean.linear().transpose() * pose.mean.linear()).eval(),
        IsMatrixNear(Eigen::Matrix3d::Identity(), 1e-14));
}
