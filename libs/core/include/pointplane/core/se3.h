// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

namespace pointplane
{
/** @name SE(3) in the project's single convention
 * Tangent xi = [rho; omega] (translation [m], rotation [rad]); T_a_b maps coordinates:
 * p_a = T_a_b * p_b. Formulas: Sola et al., "A micro Lie theory", 2018.
 * @{ */

/** Skew-symmetric matrix: hat(a) b = a x b. */
[[nodiscard]] Eigen::Matrix3d hat(const Eigen::Vector3d& a);

/** Rotation exp(omega). \param omega rotation vector [rad] */
[[nodiscard]] Eigen::Matrix3d so3Exp(const Eigen::Vector3d& omega);

/** Rotation vector [rad] of R, with norm in [0, pi]. */
[[nodiscard]] Eigen::Vector3d so3Log(const Eigen::Matrix3d& R);

/** Rigid motion exp(xi). */
[[nodiscard]] Eigen::Isometry3d se3Exp(const Vector6d& xi);

/** Tangent of T: se3Exp(se3Log(T)) == T for rotations below pi. */
[[nodiscard]] Vector6d se3Log(const Eigen::Isometry3d& T);

/** 6x6 adjoint: T exp(xi) T^-1 = exp(Ad(T) xi). */
[[nodiscard]] Matrix6d adjoint(const Eigen::Isometry3d& T);

/** Re-orthonormalises the rotation, for poses that are composed over hours. */
[[nodiscard]] Eigen::Isometry3d orthonormalised(const Eigen::Isometry3d& T);

/** The rotation R with the largest trace of R^T S: with S = sum of a b^T, that by which the b come
 * closest to the a in the least-squares sense, never a reflection (Kabsch 1976, 1978). */
[[nodiscard]] Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& S);
/** @} */
}  // namespace pointplane
