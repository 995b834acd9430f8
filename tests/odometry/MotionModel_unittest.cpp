// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/odometry/MotionModel.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "matchers.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr double kFrame = 1.0 / 30;

Vector6d velocity()
{
    Vector6d v;
    v << 0.3, -0.1, 0.2, 0.5, -0.4, 0.1;
    return v;
}

MotionModel moving()
{
    MotionModel model({});
    model.update(se3Exp(velocity() * kFrame), kFrame);
    return model;
}
}  // namespace

TEST(MotionModel, knowsNothingAtTheStart)
{
    const MotionModel model({});
    EXPECT_FALSE(model.hasVelocity());
    const PoseGaussian p = model.predict(kFrame);
    EXPECT_TRUE(p.mean.isApprox(Eigen::Isometry3d::Identity()));
    EXPECT_TRUE(isPositiveDefinite(p.cov));
    // As fast as hands move: 0.5 m/s and 1 rad/s.
    EXPECT_NEAR(std::sqrt(p.cov(0, 0)), 0.5 * kFrame, 1e-12);
    EXPECT_NEAR(std::sqrt(p.cov(3, 3)), 1.0 * kFrame, 1e-12);
}

TEST(MotionModel, keepsTheVelocity)
{
    const MotionModel model = moving();
    EXPECT_TRUE(model.hasVelocity());
    EXPECT_THAT(model.velocity(), test::IsMatrixNear(velocity(), 1e-12));
    for (const double dt : {kFrame, 0.1})
    {
        EXPECT_THAT(
            model.predict(dt).mean, test::IsNearPose(se3Exp(velocity() * dt), 1e-12, 1e-12));
    }
}

TEST(MotionModel, uncertaintyIsThatOfAWhiteAcceleration)
{
    MotionModel::TParams params;
    params.sigmaAcceleration = 2;
    params.sigmaAngularAcceleration = 6;
    MotionModel model(params);
    model.update(Eigen::Isometry3d::Identity(), kFrame);
    // The velocity is that of the middle of the latest increment.
    const double dt = 0.05, span = dt + 0.5 * kFrame;
    const PoseGaussian p = model.predict(dt);
    EXPECT_NEAR(std::sqrt(p.cov(1, 1)), 2 * span * dt, 1e-12);
    EXPECT_NEAR(std::sqrt(p.cov(4, 4)), 6 * span * dt, 1e-12);
    EXPECT_TRUE(p.cov.isDiagonal());
}

TEST(MotionModel, velocityDecaysAndUncertaintyGrowsWhileCoasting)
{
    MotionModel model = moving();
    double previousSigma = 0;
    for (int i = 1; i <= 10; ++i)
    {
        model.coast(kFrame);
        EXPECT_THAT(model.velocity(), test::IsMatrixNear(velocity() * std::pow(0.9, i), 1e-12));
        const double sigma = std::sqrt(model.predict(kFrame).cov(0, 0));
        EXPECT_GT(sigma, previousSigma);
        previousSigma = sigma;
    }
    model.update(Eigen::Isometry3d::Identity(), kFrame);
    EXPECT_LT(std::sqrt(model.predict(kFrame).cov(0, 0)), previousSigma / 3);
}

TEST(MotionModel, decayDoesNotDependOnTheFrameRate)
{
    MotionModel slow = moving(), fast = moving();
    slow.coast(2 * kFrame);
    fast.coast(kFrame);
    fast.coast(kFrame);
    EXPECT_THAT(slow.velocity(), test::IsMatrixNear(fast.velocity(), 1e-12));
}

TEST(MotionModel, coastingForHoursStaysFinite)
{
    MotionModel model = moving();
    for (int i = 0; i < 200000; ++i)
    {
        model.coast(kFrame);
    }
    model.coast(1e5);
    EXPECT_LT(model.velocity().norm(), 1e-12);
    EXPECT_TRUE(isPositiveDefinite(model.predict(kFrame).cov));
    EXPECT_LT(std::sqrt(model.predict(kFrame).cov(0, 0)), 1);
}

TEST(MotionModel, anyStepStaysFinite)
{
    MotionModel model({});
    for (const double dt : {1e4, 1e12, 1e300, std::numeric_limits<double>::infinity()})
    {
        const PoseGaussian predicted = model.predict(dt);
        EXPECT_TRUE(predicted.mean.matrix().allFinite()) << dt;
        EXPECT_TRUE(isPositiveDefinite(predicted.cov)) << dt;
    }
    // A day says nothing more than any longer time.
    EXPECT_EQ(model.predict(1e6).cov, model.predict(1e12).cov);
}

TEST(MotionModel, resetForgets)
{
    MotionModel model = moving();
    model.coast(0.1);
    model.reset();
    EXPECT_FALSE(model.hasVelocity());
    EXPECT_EQ(model.predict(kFrame).cov, MotionModel({}).predict(kFrame).cov);
}

TEST(MotionModel, refusesParametersOutOfRange)
{
    MotionModel::TParams params;
    params.decay = 1.1;
    EXPECT_THROW(params.check(), std::invalid_argument);
    params = {};
    params.sigmaAcceleration = 0;
    EXPECT_THROW(params.check(), std::invalid_argument);
    params = {};
    params.sigmaAngularAcceleration = -1;
    EXPECT_THROW(params.check(), std::invalid_argument);
}
}  // namespace pointplane
