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

/** A motion with uncertainty: pose (left perturbation) and velocity are jointly Gaussian, in this
 * order. */
struct MotionGaussian
{
    Motion mean;
    Matrix12d cov{Matrix12d::Zero()};

    [[nodiscard]] PoseGaussian pose() const { return {mean.T_prev_cur, cov.topLeftCorner<6, 6>()}; }
};

/** What is known of a motion without the current frame, with e = [log(T_mean T^-1); V_mean - V] and
 * its first half e_T: how good a pose is, and which velocity goes with it. The information is that
 * of the joint Gaussian, split because either may be doubted alone. Positive semidefinite: a
 * direction without information is free. */
struct MotionPrior
{
    Motion mean;
    Matrix6d pose{Matrix6d::Zero()};                 //!< information of e_T
    Matrix12d velocityGivenPose{Matrix12d::Zero()};  //!< information of e beyond that

    /** All that the prediction says. */
    [[nodiscard]] static MotionPrior from(const MotionGaussian& predicted);

    /** The velocity is given, of the pose nothing is known. */
    [[nodiscard]] static MotionPrior fixedVelocity(const Motion& motion);

    [[nodiscard]] Vector12d residual(const Motion& motion) const;
};
}  // namespace pointplane
