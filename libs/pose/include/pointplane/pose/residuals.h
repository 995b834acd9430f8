// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/pose/MotionGaussian.h>
#include <pointplane/pose/pairs.h>

namespace pointplane
{
/** A 3-vector residual at a motion, linearised for the LEFT perturbation exp(xi) T_prev_cur, xi =
 * [translation; rotation], and for a change of the velocity. */
struct Residual
{
    Eigen::Vector3d r{Eigen::Vector3d::Zero()};
    /** First-order propagation of both features' covariances. */
    Eigen::Matrix3d cov{Eigen::Matrix3d::Zero()};
    Eigen::Matrix3d curCov{Eigen::Matrix3d::Zero()};   //!< the current feature's share of it
    Matrix36d J{Matrix36d::Zero()};                    //!< dr / dxi
    Matrix36d J_V{Matrix36d::Zero()};                  //!< dr / dV
    ByCamera ofCamera{ByCamera::Zero()};               //!< change with errors of the camera
    Matrix36d ofReferenceVelocity{Matrix36d::Zero()};  //!< with that of the reference's velocity
};

/** r = P' - (R P + t) [P17 Eq. 8]: P' in the previous frame, P in the current camera [m]. */
[[nodiscard]] Residual pointResidual(const PointPair& pair, const Motion& motion);

/** The plane in frame a, with its covariance: theta_a = R theta_b / (1 - (R theta_b) . t). */
[[nodiscard]] PlaneGaussian transformed(
    const Eigen::Isometry3d& T_a_b, const PlaneGaussian& plane_b);

/** d theta_a / d theta_b of transformed(). */
[[nodiscard]] Eigen::Matrix3d transformJacobian(
    const Eigen::Isometry3d& T_a_b, const Eigen::Vector3d& theta_b);

/** r = theta_m' - theta_m(T): difference of the minimal forms in the previous frame [1/m]. */
[[nodiscard]] Residual planeResidualMinimal(const PlanePair& pair, const Motion& motion);

/** r = N'R (N't + d') - dN in metres [P17 Eq. 9], {R, t} = T_prev_cur: the previous frame's plane,
 * moved into the current camera, and the plane there, each as its point C = dN. */
[[nodiscard]] Residual planeResidualClosestPoint(const PlanePair& pair, const Motion& motion);
}  // namespace pointplane
