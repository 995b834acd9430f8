// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/odometry/uncertainty/FrameMean.h>

#include <optional>

namespace pointplane
{
/** Velocities and accelerations of a camera from its latest two motions, by finite differences.
 *
 * They use poses alone. So they do not drift, as velocities from the rows of a rolling shutter do;
 * but they miss what a jerk does between two frames. */
class IncrementVelocities
{
 public:
    /** What moved the camera from frame to frame. */
    struct Increment
    {
        Vector6d velocity;  //!< its mean [m/s, rad/s]
        Vector6d variance;  //!< of the motion [m^2, rad^2]
        double dt;          //!< [s]
    };

    /** Velocity where one increment ends and the next begins, by constant acceleration. */
    struct Between
    {
        Vector6d velocity;  //!< [m/s, rad/s]
        Vector6d variance;  //!< by the errors of both motions
        double dt;          //!< of both increments together [s]
        double ratio;       //!< the next one's duration over the one's before
    };

    /** \param longest that two increments may last together to tell a velocity [s]
     * \param timeConstant over which the acceleration is learnt [s] */
    IncrementVelocities(double longest, double timeConstant);

    /** \return velocity at the start of the next increment; nothing if it is the first, or if both
     * last too long */
    std::optional<Between> add(const Increment& next);

    /** The next increment will not begin where the latest ended. */
    void interrupt();

    /** Velocity at the end of the latest increment, by constant acceleration over two of them that
     * are short enough. */
    [[nodiscard]] const std::optional<Vector6d>& atEnd() const { return atEnd_; }

    /** Mean square of the acceleration, per axis, the same for three axes [m^2/s^4, rad^2/s^4];
     * zero before there were two increments. */
    [[nodiscard]] const Vector6d& acceleration2() const { return acceleration2_.value(); }

 private:
    void learnAcceleration(const Increment& next);

    double longest_, timeConstant_;
    std::optional<Increment> latest_;
    std::optional<Vector6d> atEnd_;
    FrameMean<Vector6d> acceleration2_{Vector6d::Zero()};
};
}  // namespace pointplane
