// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/pose/MotionGaussian.h>

#include <Eigen/LU>

#include "matchers.h"
#include "monte_carlo.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
TEST(MotionPrior, itsTwoPartsAreTheJointGaussian)
{
    test::GaussianSampler sampler(1);
    MotionGaussian predicted;
    predicted.mean = {se3Exp(0.2 * sampler.vector<6>()), sampler.vector<6>()};
    predicted.cov = sampler.covariance<12>(1e-4, 1e-1);
    const MotionPrior prior = MotionPrior::from(predicted);
    Matrix12d information = prior.velocityGivenPose;
    information.topLeftCorner<6, 6>() += prior.pose;
    EXPECT_THAT(
        Matrix12d(information * predicted.cov),
        test::IsMatrixNear(Matrix12d::Identity().eval(), 1e-8));
    EXPECT_THAT(
        Matrix6d(prior.pose * predicted.pose().cov),
        test::IsMatrixNear(Matrix6d::Identity().eval(), 1e-9));
}

TEST(MotionPrior, ofConstantVelocityTheVelocityFollowsThePose)
{
    // One axis, white acceleration from a known velocity: V = V_mean + 3/2 e_T / dt.
    const double dt = 0.1, q = 0.7;
    MotionGaussian predicted;
    predicted.cov << Matrix6d::Identity() * (q * dt * dt * dt / 3),
        Matrix6d::Identity() * (q * dt * dt / 2), Matrix6d::Identity() * (q * dt * dt / 2),
        Matrix6d::Identity() * (q * dt);
    const MotionPrior prior = MotionPrior::from(predicted);
    Vector12d e = Vector12d::Zero();
    e[0] = 0.02;
    e[6] = 1.5 * e[0] / dt;
    EXPECT_LT((prior.velocityGivenPose * e).norm(), 1e-9);
    // What remains of V: q dt / 4.
    EXPECT_NEAR(prior.velocityGivenPose(6, 6), 4 / (q * dt), 1e-9);
}

TEST(MotionPrior, fixedVelocityLeavesThePoseFree)
{
    Motion motion;
    motion.velocity[2] = 0.4;
    const MotionPrior prior = MotionPrior::fixedVelocity(motion);
    EXPECT_EQ(prior.pose, Matrix6d::Zero());
    const Matrix6d onPose = prior.velocityGivenPose.topLeftCorner<6, 6>();
    EXPECT_EQ(onPose, Matrix6d::Zero());
    EXPECT_GE(prior.velocityGivenPose(6, 6), 1e10);
}

TEST(MotionPrior, residualIsTheDeviationFromIt)
{
    test::GaussianSampler sampler(2);
    MotionPrior prior;
    prior.mean = {se3Exp(sampler.vector<6>()), sampler.vector<6>()};
    const Vector6d xi = 0.1 * sampler.vector<6>(), dV = sampler.vector<6>();
    Vector12d expected;
    expected << xi, dV;
    const Motion motion{se3Exp(-xi) * prior.mean.T_prev_cur, prior.mean.velocity - dV};
    EXPECT_THAT(prior.residual(motion), test::IsMatrixNear(expected, 1e-12));
}
}  // namespace pointplane
