// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

namespace pointplane
{
/** A rigid motion with uncertainty: T_a_b = exp(xi) * mean, xi ~ N(0, cov).
 *
 * The perturbation is on the LEFT (expressed in frame a), tangent order [translation; rotation],
 * units m and rad. mrpt_io converts to MRPT's (x, y, z, yaw, pitch, roll). */
struct PoseGaussian
{
    Eigen::Isometry3d mean{Eigen::Isometry3d::Identity()};  //!< T_a_b
    Matrix6d cov{Matrix6d::Zero()};                         //!< 6x6 tangent covariance [m, rad]
};

/** T_a_c = T_a_b * T_b_c for independent motions: cov_ac = cov_ab + Ad(T_ab) cov_bc Ad(T_ab)^T. */
[[nodiscard]] PoseGaussian compose(const PoseGaussian& T_a_b, const PoseGaussian& T_b_c);

/** T_b_a: cov_ba = Ad(T_ba) cov_ab Ad(T_ba)^T. */
[[nodiscard]] PoseGaussian inverse(const PoseGaussian& T_a_b);

/** The same motion seen from a frame s rigidly attached to the moving frame:
 * T_s_c * T_a_b * T_s_c^-1, with T_s_c exact (e.g. robot from camera). */
[[nodiscard]] PoseGaussian changeFrame(const Eigen::Isometry3d& T_s_c, const PoseGaussian& T_a_b);

/** Left error of an estimate: log(truth * mean^-1), the vector whose covariance is cov. */
[[nodiscard]] Vector6d leftError(const Eigen::Isometry3d& truth, const Eigen::Isometry3d& mean);
}  // namespace pointplane
