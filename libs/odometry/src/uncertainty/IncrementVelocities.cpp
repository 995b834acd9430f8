// SPDX-License-Identifier: BSD-3-Clause
#include "IncrementVelocities.h"

#include <cmath>

namespace pointplane
{
namespace
{
/** Times that one step may be as long as the next, where they tell an acceleration. */
constexpr double kUnequal = 8;
}  // namespace

IncrementVelocities::IncrementVelocities(double longest, double timeConstant)
    : longest_(longest), timeConstant_(timeConstant)
{
}

std::optional<IncrementVelocities::Between> IncrementVelocities::add(const Increment& next)
{
    std::optional<Between> out;
    atEnd_.reset();
    if (latest_)
    {
        learnAcceleration(next);
        const Increment& last = *latest_;
        const double dt = last.dt + next.dt;
        if (dt <= longest_)
        {
            const double ratio = next.dt / last.dt;
            const Vector6d variances =
                (ratio * ratio * last.variance + next.variance / (ratio * ratio)) / (dt * dt);
            out = {
                (next.dt * last.velocity + last.dt * next.velocity) / dt,
                perAxis(variances.head<3>().mean(), variances.tail<3>().mean()),
                dt,
                ratio};
            atEnd_ = next.velocity + (next.velocity - last.velocity) * next.dt / dt;
        }
    }
    latest_ = next;
    return out;
}

void IncrementVelocities::learnAcceleration(const Increment& next)
{
    // Over a step that is much shorter than another, noise of the pose looks like a jerk.
    if (next.dt > kUnequal * latest_->dt || latest_->dt > kUnequal * next.dt)
    {
        return;
    }
    const Vector6d a = 2 * (next.velocity - latest_->velocity) / (next.dt + latest_->dt);
    acceleration2_.follow(
        perAxis(a.head<3>().squaredNorm() / 3, a.tail<3>().squaredNorm() / 3),
        1 - std::exp(-next.dt / timeConstant_));
}

void IncrementVelocities::interrupt()
{
    latest_.reset();
    atEnd_.reset();
}
}  // namespace pointplane
