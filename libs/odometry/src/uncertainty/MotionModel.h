// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/uncertainty/MotionParams.h>
#include <pointplane/pose/MotionGaussian.h>

#include "IncrementVelocities.h"
#include "decaying_velocity.h"

namespace pointplane
{
/** Predicts the next frame's motion: the velocity decays ([P17, section Pose estimation], after
 * Klein and Murray 2007) and changes by white acceleration (Ornstein and Uhlenbeck 1930). It learns
 * how fast the camera is, and how much the velocity changes. From both follows for how long the
 * camera keeps its velocity. Derivation: docs/theory.md, Motion. */
class MotionModel
{
 public:
    /** Velocity of a frame, now that the next one is known. It is linear in what it was made from:
     * each matrix is the factor of the error of ... */
    struct Smoothed
    {
        Vector6d velocity{Vector6d::Zero()};
        Matrix6d byVelocity{Matrix6d::Identity()};    //!< ... its velocity as estimated before
        Matrix6d byNextVelocity{Matrix6d::Zero()};    //!< ... the velocity of the next frame
        Matrix6d byNextMotion{Matrix6d::Zero()};      //!< ... the motion to the next frame
        Matrix6d byPreviousMotion{Matrix6d::Zero()};  //!< ... the motion from the frame before
    };

    /** Limit of the input: after a longer time [s] nothing more can become unknown: the camera may
     * be 500 m away. With larger variances, those of later motions would be lost in rounding. */
    static constexpr double kLongestStep = 10;

    /** \throws std::invalid_argument naming the key */
    explicit MotionModel(const MotionParams& params);

    /** Predicted motion over `dt` [s] from the latest frame, measured or not: T_prev_cur and the
     * velocity at its end. \pre dt > 0 */
    [[nodiscard]] MotionGaussian predict(double dt) const;

    /** Covariance of velocity() [m/s, rad/s]. */
    [[nodiscard]] Matrix6d velocityCov() const;

    /** What becomes of pose and velocity in `dt` [s]. */
    [[nodiscard]] DecayedVelocities after(double dt) const;

    /** Motion over `dt` [s] from the latest measured frame, as it will be measured: T_prev_cur from
     * the estimated pose of that frame, and the velocity at its end. So the covariance holds the
     * error of that pose, too, which correlates with that of the velocity. \pre dt > 0 */
    [[nodiscard]] MotionGaussian predictFromEstimate(double dt) const;

    /** Covariance of p in docs/theory.md: that of predictFromEstimate() without the errors of the
     * previous pose and velocity, of which JointCovariance keeps account. Over steps shorter than
     * an acceleration lasts, a measured pose tells the velocity better than white acceleration
     * would. Where the pose is not measured, it tells nothing, and a sudden acceleration stays
     * unseen: then this is unforeseen().
     * \param open how far the estimated pose is the predicted one (H^-1 H_0): zero in directions
     * that are measured, one in those that are not */
    [[nodiscard]] Matrix12d processNoise(double dt, const Matrix6d& open) const;

    /** Covariance of pose and velocity after `dt` [s] if the velocity before is known: by white
     * acceleration and, of the pose, by a sudden one. */
    [[nodiscard]] Matrix12d unforeseen(double dt) const;

    /** Covariance of the pose by a sudden acceleration, over `dt` [s]. */
    [[nodiscard]] Matrix6d bySuddenAcceleration(double dt) const;

    /** Takes the mean velocity of a measured increment for the velocity at its end, as in the
     * paper. */
    void follow(const Eigen::Isometry3d& T_prev_cur, double dt);

    /** Learns from a measured motion over `dt` [s].
     * \return the velocity at its start, now that its end is known. Two estimates are weighed by
     * their variances, because they err for different reasons. The smoother (Rauch-Tung-Striebel)
     * goes by the rows of the shutter. These tell only how velocities differ from those of the
     * references, so it wanders with them. The increments before and after miss jerks. */
    Smoothed update(const MotionGaussian& measured, double dt);

    /** Moves the velocity half way to what the latest two increments say of it, by constant
     * acceleration. For odometry from frame to frame: the next frame measures its velocity against
     * this one, before a later increment can correct it. */
    void followIncrements();

    /** The next motion starts at a frame to which others are compared: its pose has no error. */
    void startAtReference();

    /** Passes `dt` [s] without a measurement. */
    void coast(double dt);

    /** Body velocity at the latest frame, measured or not [m/s, rad/s]. */
    [[nodiscard]] Vector6d velocity() const;

    /** Variance that the velocity gains per second, as learnt [m^2/s^3, rad^2/s^3]. */
    [[nodiscard]] Vector6d density() const;

    /** IncrementVelocities::acceleration2() */
    [[nodiscard]] const Vector6d& acceleration2() const { return increments_.acceleration2(); }

    /** Forgets the velocity. How fast the camera is, and how much that changes, are not less than
     * they were or than at the start: what is unknown is not more certain than what was known. */
    void reset();

 private:
    /** Variance that the velocity gains in `dt` [s]. */
    [[nodiscard]] Vector6d velocityGain(double dt) const;
    [[nodiscard]] MotionGaussian predictFrom(
        const Vector6d& velocity, const Matrix12d& cov, double dt) const;
    void learn(const Vector6d& square, double dt, Vector6d& meanSquare) const;
    [[nodiscard]] Vector6d smallestDensity() const;
    [[nodiscard]] Vector6d sudden() const;  //!< acceleration, per axis
    void weigh(const IncrementVelocities::Between& between, double dt, Smoothed& smoothed) const;

    MotionParams params_;
    Vector6d velocity_;  //!< at the frame where the next motion starts
    /** Of [pose of that frame; velocity_], by what the frame itself tells. JointCovariance has that
     * of the velocity by all that its errors come from. */
    Matrix12d cov_{Matrix12d::Zero()};
    Matrix6d measuredVelocityCov_{Matrix6d::Zero()};  //!< the part of it that was measured
    Vector6d learntDensity_{Vector6d::Zero()};        //!< density() without its lower limit
    Vector6d speed2_{Vector6d::Zero()};               //!< mean square of the velocity, per axis
    double elapsed_{0};                               //!< since that frame [s]
    IncrementVelocities increments_;
};
}  // namespace pointplane
