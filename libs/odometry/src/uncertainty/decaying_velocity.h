// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

namespace pointplane
{
/** What becomes of pose and velocity in a time t, if the velocity decays and is pushed at random:
 * dV = -V / timeConstant dt + sqrt(q) dW (Ornstein and Uhlenbeck 1930). Gains are those for q = 1.
 * Derivation: docs/theory.md, Motion. */
struct DecayedVelocity
{
    double reach{0};     //!< the pose moves by the velocity before times this [s]
    double kept{1};      //!< the velocity is the one before times this [-]
    double pose{0};      //!< variance that the pose gains [s^3]
    double together{0};  //!< covariance that pose and velocity gain [s^2]
    double velocity{0};  //!< variance that the velocity gains [s]
};

/** \param t [s], not negative \param timeConstant [s], positive; infinity: it does not decay */
[[nodiscard]] DecayedVelocity decayedVelocity(double t, double timeConstant);

/** The same of translation and rotation: vectors with a value per axis. */
struct DecayedVelocities
{
    DecayedVelocity translation, rotation;

    [[nodiscard]] Vector6d reach() const { return each(&DecayedVelocity::reach); }
    [[nodiscard]] Vector6d kept() const { return each(&DecayedVelocity::kept); }
    [[nodiscard]] Vector6d pose() const { return each(&DecayedVelocity::pose); }
    [[nodiscard]] Vector6d together() const { return each(&DecayedVelocity::together); }
    [[nodiscard]] Vector6d velocity() const { return each(&DecayedVelocity::velocity); }

 private:
    [[nodiscard]] Vector6d each(double DecayedVelocity::*value) const
    {
        return perAxis(translation.*value, rotation.*value);
    }
};
}  // namespace pointplane
