// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

namespace pointplane
{
/** Infinite plane n.x + d = 0, |n| = 1 (as mrpt::math::TPlane). A measured plane has d > 0 in its
 * camera's frame (n points to the camera); transforms carry the sign along. */
struct Plane
{
    Eigen::Vector3d n{0, 0, -1};  //!< unit normal
    double d{1};                  //!< signed distance of the origin [m]
};

/** Minimal form theta_m = n / d [1/m] [P17, after Eq. 2]. On the plane, theta_m . P + 1 = 0. The
 * inverse depth along a ray (x, y, 1) is -theta_m . ray.
 * \throws std::invalid_argument if d = 0 */
[[nodiscard]] Eigen::Vector3d minimalForm(const Plane& plane);

/** Hessian form from theta_m [P17 Eq. 6], with d = 1 / |theta_m| > 0.
 * \throws std::invalid_argument if theta_m = 0, the plane at infinity */
[[nodiscard]] Plane hessianForm(const Eigen::Vector3d& theta_m);

/** 4x3 Jacobian of (n, d) with respect to theta_m [P17, after Eq. 6]. */
[[nodiscard]] Matrix43d jacobianHessianForm(const Eigen::Vector3d& theta_m);

/** The plane in frame a: n_a = R n_b, d_a = d_b - n_a . t. */
[[nodiscard]] Plane transformed(const Eigen::Isometry3d& T_a_b, const Plane& plane_b);

/** Plane with uncertainty in its minimal form. */
struct PlaneGaussian
{
    Eigen::Vector3d theta_m{0, 0, -1};               //!< n / d [1/m]
    Eigen::Matrix3d cov_m{Eigen::Matrix3d::Zero()};  //!< covariance of theta_m [1/m^2]
};

/** 4x4 covariance of the Hessian form (rank 3) [P17, after Eq. 6]. */
[[nodiscard]] Eigen::Matrix4d hessianCovariance(const PlaneGaussian& plane);
}  // namespace pointplane
