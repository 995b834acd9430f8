// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>

namespace pointplane
{
/** How a camera is expected to move. */
struct MotionParams
{
    double velocityRandomWalk{0.1};
    double angularVelocityRandomWalk{0.5};
    double timeConstant{1.0};
    double sigmaAcceleration{5.0};
    double sigmaAngularAcceleration{15.0};
    double accelerationTime{0.05};

    template <class V>
    void visit(V&& v)
    {
        v("velocityRandomWalk",
          velocityRandomWalk,
          "m/s/sqrt(s)",
          "least change of the velocity, per axis; more is learnt from the motion");
        v("angularVelocityRandomWalk",
          angularVelocityRandomWalk,
          "rad/s/sqrt(s)",
          "the same of the angular velocity");
        v("timeConstant",
          timeConstant,
          "s",
          "time over which the velocity's change and size are learnt");
        v("sigmaAcceleration",
          sigmaAcceleration,
          "m/s^2",
          "standard deviation of a sudden acceleration; larger = trust the predicted motion "
          "less");
        v("sigmaAngularAcceleration",
          sigmaAngularAcceleration,
          "rad/s^2",
          "the same of the rotation");
        v("accelerationTime",
          accelerationTime,
          "s",
          "how long a sudden acceleration lasts; the speed that it makes in this time is the "
          "first guess of the camera's");
    }
    /** \throws std::invalid_argument naming the key */
    void check() const;
};
}  // namespace pointplane
