// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>

namespace pointplane
{
/** Pose of the current camera and its velocity at that instant. */
struct Motion
{
    Eigen::Isometry3d T_prev_cur{Eigen::Isometry3d::Identity()};
    Vector6d velocity{Vector6d::Zero()};  //!< body velocity [m/s, rad/s]
};

/** A motion with uncertainty. cov is that of [left perturbation of the pose; velocity], in m, rad,
 * m/s, rad/s. */
struct MotionGaussian
{
    Motion mean;
    Matrix12d cov{Matrix12d::Zero()};

    [[nodiscard]] PoseGaussian pose() const { return {mean.T_prev_cur, cov.topLeftCorner<6, 6>()}; }
};

/** Standard deviation of what is known exactly [m, rad, m/s, rad/s]: small, but far from the limits
 * of double precision. */
constexpr double kExactSigma = 1e-6;

/** What is known of a motion without the current frame.
 *
 * Its error is e = [log(T_mean T^-1); V_mean - V], with first half e_T. The information of the
 * joint Gaussian is split in two, because either may be doubted alone: how good the pose is, and
 * which velocity goes with it. Both are positive semidefinite: a direction without information is
 * free. */
struct MotionPrior
{
    Motion mean;
    Matrix6d pose{Matrix6d::Zero()};                 //!< information of e_T
    Matrix12d velocityGivenPose{Matrix12d::Zero()};  //!< information of e without that of e_T

    /** A prior with all that a prediction says. */
    [[nodiscard]] static MotionPrior from(const MotionGaussian& predicted);

    /** A prior that fixes the velocity and says nothing of the pose. */
    [[nodiscard]] static MotionPrior fixedVelocity(const Motion& motion);

    /** e of a motion. */
    [[nodiscard]] Vector12d residual(const Motion& motion) const;
};
}  // namespace pointplane
