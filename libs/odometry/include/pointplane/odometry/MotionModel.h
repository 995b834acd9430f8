// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/pose/MotionGaussian.h>

namespace pointplane
{
/** What is known of the next frame's motion: constant velocity with white acceleration (a Wiener
 * velocity model, e.g. Anderson and Barfoot 2015), and without measurements the decaying velocity of
 * Klein & Murray 2007, quoted in [P17, section Pose estimation]. */
class MotionModel
{
 public:
    struct TParams
    {
        double decay{0.9};
        double velocityRandomWalk{0.1};
        double angularVelocityRandomWalk{0.5};
        double timeConstant{1.0};

        template <class V>
        void visit(V&& v)
        {
            v("decay", decay, "-", "of the velocity kept over 1/30 s when a frame is not measured");
            v("velocityRandomWalk",
              velocityRandomWalk,
              "m/s/sqrt(s)",
              "change of velocity of a hand-held camera, per axis");
            v("angularVelocityRandomWalk",
              angularVelocityRandomWalk,
              "rad/s/sqrt(s)",
              "change of angular velocity, per axis");
            v("timeConstant", timeConstant, "s", "both adapt to the motion over this time, and are never below the above");
        }
        void check() const;
    };

    explicit MotionModel(const TParams& params);

    /** Motion over `dt` [s] from the latest measured frame: T_prev_cur and the velocity after it.
     * \pre dt > 0 */
    [[nodiscard]] MotionGaussian predict(double dt) const;

    /** A measured motion over `dt`. \return the velocity at its start, now that its end is known
     * (Rauch-Tung-Striebel) */
    Vector6d update(const MotionGaussian& measured, double dt);

    /** No measurement over `dt`: the velocity decays, its uncertainty grows. */
    void coast(double dt);

    void reset();

 private:
    void adapt(const MotionGaussian& predicted, const MotionGaussian& measured, const Vector12d& innovation, double dt);

    TParams params_;
    Vector6d density_;  //!< of the white acceleration [m^2/s^3, rad^2/s^3]
    Vector6d velocity_;
    Matrix6d cov_;
};
}  // namespace pointplane
