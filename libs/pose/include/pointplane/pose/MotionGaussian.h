// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>

namespace pointplane
{
/** Pose of the current camera and its velocity at that instant. */
struct Motion
{
    Eigen::Isometry3d T_base_cur{Eigen::Isometry3d::Identity()};
    Vector6d velocity{Vector6d::Zero()};  //!< body velocity [m/s, rad/s]
};

/** A motion with uncertainty: pose (left perturbation) and velocity are jointly Gaussian, in this
 * order. */
struct MotionGaussian
{
    Motion mean;
    Matrix12d cov{Matrix12d::Zero()};

    [[nodiscard]] PoseGaussian pose() const
    {
        return {mean.T_base_cur, cov.topLeftCorner<6, 6>()};
    }
};

/** What is known of a motion without the current frame: E = |e|^2 with weight `information`, e =
 * [log(T_mean T^-1); V_mean - V]. Positive semidefinite: a direction without information is free. */
struct MotionPrior
{
    Motion mean;
    Matrix12d information{Matrix12d::Zero()};

    /** All that the prediction says. */
    [[nodiscard]] static MotionPrior from(const MotionGaussian& predicted);

    /** Only the velocity that goes with a pose; of the pose itself, nothing. */
    [[nodiscard]] static MotionPrior velocityGivenPose(const MotionGaussian& predicted);

    /** The velocity is given, of the pose nothing is known. */
    [[nodiscard]] static MotionPrior fixedVelocity(const Motion& motion);

    [[nodiscard]] Vector12d residual(const Motion& motion) const;
};
}  // namespace pointplane
