// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/IncrementVelocities.h"

#include <cmath>

#include "matchers.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr double kLongest = 0.2, kTimeConstant = 1;

IncrementVelocities::Increment increment(double velocity, double dt, double variance = 0)
{
    return {Vector6d::Constant(velocity), Vector6d::Constant(variance), dt};
}
}  // namespace

/** Mean velocities hold in the middle of the increments: 1 at 0.01 s before, 4 at 0.02 s after. */
TEST(IncrementVelocities, betweenTwoByHand)
{
    IncrementVelocities increments(kLongest, kTimeConstant);
    EXPECT_FALSE(increments.add(increment(1, 0.02)));
    EXPECT_FALSE(increments.atEnd());
    const auto between = increments.add(increment(4, 0.04));
    ASSERT_TRUE(between);
    EXPECT_NEAR(between->velocity[2], 2, 1e-12);
    EXPECT_NEAR(between->dt, 0.06, 1e-12);
    EXPECT_NEAR(between->ratio, 2, 1e-12);
    EXPECT_NEAR((*increments.atEnd())[5], 6, 1e-12) << "0.02 s after the middle of the latest";
    EXPECT_NEAR(increments.acceleration2()[0], 100 * 100, 1e-9);
}

/** Any motion of constant acceleration is told exactly, by steps of any length. */
TEST(IncrementVelocities, constantAccelerationIsTold)
{
    for (const double second : {0.01, 0.03, 0.1})
    {
        const double first = 0.03, start = 0.5, acceleration = -2;
        const double middle = start + acceleration * first;
        IncrementVelocities increments(kLongest, kTimeConstant);
        (void)increments.add(increment((start + middle) / 2, first));
        const auto between = increments.add(increment(middle + acceleration * second / 2, second));
        ASSERT_TRUE(between);
        EXPECT_NEAR(between->velocity[0], middle, 1e-12);
        EXPECT_NEAR((*increments.atEnd())[0], middle + acceleration * second, 1e-12);
        EXPECT_NEAR(increments.acceleration2()[3], 4, 1e-9);
    }
}

/** Errors of the poses make the variance that is stated: against finite differences. */
TEST(IncrementVelocities, varianceIsThatOfThePoses)
{
    const double first = 0.03, second = 0.05, step = 1e-6;
    // Velocity between increments whose motions are longer by these.
    const auto velocity = [&](double ofFirst, double ofSecond)
    {
        IncrementVelocities increments(kLongest, kTimeConstant);
        (void)increments.add(increment(1 + ofFirst / first, first, 4));
        return *increments.add(increment(2 + ofSecond / second, second, 9));
    };
    const auto at = velocity(0, 0);
    const double byFirst = (velocity(step, 0).velocity[0] - at.velocity[0]) / step;
    const double bySecond = (velocity(0, step).velocity[0] - at.velocity[0]) / step;
    EXPECT_NEAR(byFirst, at.ratio / at.dt, 1e-6);
    EXPECT_NEAR(bySecond, 1 / (at.ratio * at.dt), 1e-6);
    EXPECT_NEAR(at.variance[0], 4 * byFirst * byFirst + 9 * bySecond * bySecond, 1e-4);
}

TEST(IncrementVelocities, longStepsTellNoVelocityButAcceleration)
{
    IncrementVelocities increments(kLongest, kTimeConstant);
    (void)increments.add(increment(1, 0.15));
    EXPECT_FALSE(increments.add(increment(2, 0.15)));
    EXPECT_FALSE(increments.atEnd());
    EXPECT_GT(increments.acceleration2()[0], 0);
}

/** A tiny step after a usual one: noise of the pose over it looks like a jerk. */
TEST(IncrementVelocities, unequalStepsTellNoAcceleration)
{
    IncrementVelocities increments(kLongest, kTimeConstant);
    (void)increments.add(increment(1, 0.03));
    (void)increments.add(increment(50, 0.001));
    EXPECT_TRUE(increments.acceleration2().isZero(0));
}

/** The acceleration stays known; two increments with a gap between tell no velocity. */
TEST(IncrementVelocities, interrupted)
{
    IncrementVelocities increments(kLongest, kTimeConstant);
    (void)increments.add(increment(1, 0.03));
    (void)increments.add(increment(2, 0.03));
    const Vector6d before = increments.acceleration2();
    increments.interrupt();
    EXPECT_FALSE(increments.atEnd());
    EXPECT_FALSE(increments.add(increment(9, 0.03)));
    EXPECT_EQ(increments.acceleration2(), before);
}

/** A mean at first, then an average over the time constant. */
TEST(IncrementVelocities, accelerationIsAveraged)
{
    IncrementVelocities increments(kLongest, kTimeConstant);
    double velocity = 0;
    const auto accelerate = [&](double acceleration)
    {
        velocity += acceleration * 0.1;
        (void)increments.add(increment(velocity, 0.1));
        return increments.acceleration2()[1];
    };
    (void)accelerate(0);
    EXPECT_NEAR(accelerate(1), 1, 1e-9);
    EXPECT_NEAR(accelerate(3), 5, 1e-9) << "mean of 1 and 9";
    for (int i = 0; i < 100; ++i)
    {
        (void)accelerate(2);
    }
    EXPECT_NEAR(accelerate(2), 4, 1e-3) << "ten seconds later";
}
}  // namespace pointplane
