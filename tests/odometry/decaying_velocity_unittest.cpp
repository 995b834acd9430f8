// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/decaying_velocity.h"

#include <cmath>
#include <limits>

#include "monte_carlo.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
Eigen::Matrix2d transition(const DecayedVelocity& after)
{
    Eigen::Matrix2d out;
    out << 1, after.reach, 0, after.kept;
    return out;
}

Eigen::Matrix2d gain(const DecayedVelocity& after)
{
    Eigen::Matrix2d out;
    out << after.pose, after.together, after.together, after.velocity;
    return out;
}
}  // namespace

TEST(DecayingVelocity, byHandAfterTheTimeConstant)
{
    const DecayedVelocity after = decayedVelocity(2, 2);
    const double e = std::exp(-1.0);
    EXPECT_NEAR(after.kept, e, 1e-12);
    EXPECT_NEAR(after.reach, 2 * (1 - e), 1e-12);
    EXPECT_NEAR(after.velocity, 1 - e * e, 1e-12);
    EXPECT_NEAR(after.together, 2 * (1 - e) * (1 - e), 1e-12);
    EXPECT_NEAR(after.pose, 8 * (1 - 2 * (1 - e) + (1 - e * e) / 2), 1e-12);
}

TEST(DecayingVelocity, withoutDecayItIsConstant)
{
    const DecayedVelocity after = decayedVelocity(0.3, std::numeric_limits<double>::infinity());
    EXPECT_EQ(after.kept, 1);
    EXPECT_EQ(after.reach, 0.3);
    EXPECT_NEAR(after.pose, 0.3 * 0.3 * 0.3 / 3, 1e-15);
    EXPECT_NEAR(after.together, 0.3 * 0.3 / 2, 1e-15);
    EXPECT_NEAR(after.velocity, 0.3, 1e-15);
}

TEST(DecayingVelocity, nothingHappensInNoTime)
{
    const DecayedVelocity after = decayedVelocity(0, 1);
    EXPECT_TRUE(transition(after).isIdentity(0));
    EXPECT_TRUE(gain(after).isZero(0));
}

/** In the end, nothing is left of the velocity before, and the new one has its usual variance. */
TEST(DecayingVelocity, forgetsItself)
{
    const DecayedVelocity after = decayedVelocity(100, 0.5);
    EXPECT_NEAR(after.kept, 0, 1e-12);
    EXPECT_NEAR(after.reach, 0.5, 1e-12);
    EXPECT_NEAR(after.velocity, 0.5 / 2, 1e-12);
}

TEST(DecayingVelocity, twoStepsAreOne)
{
    for (const double tau : {1e-3, 0.1, 1.0, 1e3, 1e5})
    {
        const DecayedVelocity a = decayedVelocity(0.02, tau), b = decayedVelocity(0.3, tau);
        const DecayedVelocity both = decayedVelocity(0.32, tau);
        const Eigen::Matrix2d F = transition(b);
        EXPECT_TRUE((F * transition(a)).isApprox(transition(both), 1e-7)) << tau;
        EXPECT_TRUE((F * gain(a) * F.transpose() + gain(b)).isApprox(gain(both), 1e-6)) << tau;
    }
}

/** The series for short times meets the closed form. */
TEST(DecayingVelocity, isContinuous)
{
    const DecayedVelocity below = decayedVelocity(0.999999e-4, 1);
    const DecayedVelocity above = decayedVelocity(1.000001e-4, 1);
    EXPECT_NEAR(below.reach / above.reach, 1, 1e-5);
    EXPECT_NEAR(below.pose / above.pose, 1, 1e-5);
    EXPECT_NEAR(below.together / above.together, 1, 1e-5);
    EXPECT_NEAR(below.velocity / above.velocity, 1, 1e-5);
}

TEST(DecayingVelocity, againstManyWalks)
{
    constexpr double kTau = 0.2, kTime = 0.3, kStep = kTime / 300, kQ = 0.5, kStart = 0.4;
    constexpr int kWalks = 4000;
    test::GaussianSampler sampler(3);
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    for (int i = 0; i < kWalks; ++i)
    {
        double x = 0, v = kStart;
        for (double t = 0; t < kTime - kStep / 2; t += kStep)
        {
            x += v * kStep;
            v += -v / kTau * kStep + std::sqrt(kQ * kStep) * sampler.vector<1>()[0];
        }
        const Eigen::Vector2d end(x, v);
        mean += end / kWalks;
        square += end * end.transpose() / kWalks;
    }
    const DecayedVelocity after = decayedVelocity(kTime, kTau);
    const Eigen::Matrix2d cov = square - mean * mean.transpose();
    const Eigen::Matrix2d expected = kQ * gain(after);
    EXPECT_NEAR(mean[0], after.reach * kStart, 0.05 * after.reach * kStart);
    EXPECT_NEAR(mean[1], after.kept * kStart, 0.02 * kStart);
    EXPECT_NEAR(cov(0, 0), expected(0, 0), 0.08 * expected(0, 0));
    EXPECT_NEAR(cov(0, 1), expected(0, 1), 0.08 * expected(0, 1));
    EXPECT_NEAR(cov(1, 1), expected(1, 1), 0.08 * expected(1, 1));
}
}  // namespace pointplane
