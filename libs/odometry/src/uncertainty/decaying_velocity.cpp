// SPDX-License-Identifier: BSD-3-Clause
#include "decaying_velocity.h"

#include <cmath>

namespace pointplane
{
DecayedVelocity decayedVelocity(double t, double timeConstant)
{
    DecayedVelocity out;
    const double x = t / timeConstant;
    if (x < 1e-4)
    {
        // To first order: the differences below would be lost in rounding.
        out.reach = t * (1 - x / 2);
        out.kept = 1 - x;
        out.pose = t * t * t * (1.0 / 3 - x / 4);
        out.together = t * t * (0.5 - x / 2);
        out.velocity = t * (1 - x);
        return out;
    }
    const double lost = -std::expm1(-x), lostTwice = -std::expm1(-2 * x);
    const double tau = timeConstant;
    out.reach = tau * lost;
    out.kept = 1 - lost;
    out.pose = tau * tau * tau * (x - 2 * lost + lostTwice / 2);
    out.together = tau * tau * lost * lost / 2;
    out.velocity = tau * lostTwice / 2;
    return out;
}
}  // namespace pointplane
