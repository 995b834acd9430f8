// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/pose/MotionGaussian.h>

#include <optional>

namespace pointplane
{
/** What is known of the next frame's motion: constant velocity with white acceleration (the Wiener
 * velocity model of Anderson and Barfoot 2015), whose density follows the motion, and without
 * measurements the decaying velocity of Klein & Murray 2007, quoted in [P17, section Pose
 * estimation]. Derivation in docs/theory.md. */
class MotionModel
{
 public:
    struct TParams
    {
        double decay{0.9};
        double velocityRandomWalk{0.1};
        double angularVelocityRandomWalk{0.5};
        double timeConstant{1.0};
        double sigmaAcceleration{5.0};
        double sigmaAngularAcceleration{15.0};

        template <class V>
        void visit(V&& v)
        {
            v("decay",
              decay,
              "-",
              "fraction of the velocity that is kept over 1/30 s when a frame is not measured");
            v("velocityRandomWalk",
              velocityRandomWalk,
              "m/s/sqrt(s)",
              "least change of the velocity, per axis; more is learnt from the motion");
            v("angularVelocityRandomWalk",
              angularVelocityRandomWalk,
              "rad/s/sqrt(s)",
              "the same of the angular velocity");
            v("timeConstant", timeConstant, "s", "time over which the change is learnt");
            v("sigmaAcceleration",
              sigmaAcceleration,
              "m/s^2",
              "acceleration of a jerk that was not foreseen (standard deviation)");
            v("sigmaAngularAcceleration",
              sigmaAngularAcceleration,
              "rad/s^2",
              "the same of the rotation");
        }
        void check() const;
    };

    explicit MotionModel(const TParams& params);

    /** Motion over `dt` [s] from the latest measured frame: T_prev_cur and the velocity after it.
     * \pre dt > 0 */
    [[nodiscard]] MotionGaussian predict(double dt) const;

    /** Covariance of predict() that does not come from that of the velocity as it was measured. */
    [[nodiscard]] Matrix12d processNoise(double dt) const;

    /** Covariance of the pose by a jerk that the velocities so far do not show. */
    [[nodiscard]] Matrix6d jerk(double dt) const;

    /** A measured increment whose mean velocity is taken for the velocity at its end, as in the
     * paper. */
    void follow(const Eigen::Isometry3d& T_prev_cur, double dt);

    /** A measured motion over `dt`. \return the velocity at its start, now that its end is known:
     * two estimates that err for different reasons, weighed by variance. The smoother's
     * (Rauch-Tung-Striebel) goes by the shutter's rows, which tell only how velocities differ from
     * those of the references, and wanders with these; that of the increments before and after
     * misses jerks. */
    Vector6d update(const MotionGaussian& measured, double dt);

    /** Takes half of what the latest two increments say the velocity is at their end, by constant
     * acceleration. For motion from frame to frame: the next frame's velocity is told by rows of
     * the shutter against this one's, which no later increment can correct before. */
    void followIncrements();

    /** No measurement over `dt`: the velocity decays, its uncertainty grows. */
    void coast(double dt);

    /** Body velocity at the latest measured frame, decayed since [m/s, rad/s]. */
    [[nodiscard]] const Vector6d& velocity() const { return velocity_; }

    /** Variance that the velocity gains per second, as adapted [m^2/s^3, rad^2/s^3]. */
    [[nodiscard]] const Vector6d& density() const { return density_; }

    void reset();

 private:
    [[nodiscard]] Matrix12d covarianceAfter(double t, const Matrix6d& cov) const;
    void adapt(const Vector6d& meanSquare, double dt);
    [[nodiscard]] Vector6d smallestDensity() const;
    /** What moved the camera from frame to frame. */
    struct Increment
    {
        Vector6d velocity;  //!< its mean
        double dt;          //!< [s]
        Vector6d variance;  //!< of the pose at its end
    };
    [[nodiscard]] Vector6d betweenIncrements(const Increment& next, const Vector6d& smoothed) const;

    TParams params_;
    Vector6d velocity_;
    Matrix6d cov_;          //!< of velocity_
    Matrix6d measuredCov_;  //!< of the velocity at the latest measured frame
    Vector6d density_;
    double coasting_;  //!< time since the latest measurement, counted up to a limit [s]
    std::optional<Increment> increment_;       //!< the latest
    std::optional<Vector6d> atIncrementsEnd_;  //!< velocity, by the latest two of them
};
}  // namespace pointplane
