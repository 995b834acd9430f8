// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>
#include <pointplane/core/latest_stamp.h>

#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <string>

namespace pointplane
{
/** @name Between this project's conventions and MRPT's
 * A pose T_a_b is MRPT's "pose of b in a". Covariances: here of the tangent [translation; rotation]
 * of a perturbation on the left; in MRPT of (x, y, z, yaw, pitch, roll). The two 6x6 matrices
 * differ by the Jacobian below; copying one into the other is wrong.
 * @{ */

/** T_body_optical: MRPT's sensor axes (x forward, y left, z up) from optical axes (x right, y down,
 * z forward); the rotation of CPose3D(0, 0, 0, -90 deg, 0, -90 deg), exactly. */
[[nodiscard]] Eigen::Isometry3d opticalInBody();

[[nodiscard]] mrpt::poses::CPose3D toMrpt(const Eigen::Isometry3d& T_a_b);
[[nodiscard]] Eigen::Isometry3d fromMrpt(const mrpt::poses::CPose3D& pose);

/** 6x6 Jacobian of (x, y, z, yaw, pitch, roll) with respect to the left tangent at T_a_b. Near
 * pitch = +-90 deg yaw and roll cannot be told apart: there their variances are huge, but finite
 * (cos(pitch) is at least 1e-4). */
[[nodiscard]] Matrix6d jacobianYprOfTangent(const Eigen::Isometry3d& T_a_b);

/** Pose and covariance, through the Jacobian above; strictly positive definite.
 * \throws std::invalid_argument if pose or covariance are not finite */
[[nodiscard]] mrpt::poses::CPose3DPDFGaussian toMrpt(const PoseGaussian& T_a_b);

/** The inverse of toMrpt(). */
[[nodiscard]] PoseGaussian fromMrpt(const mrpt::poses::CPose3DPDFGaussian& pdf);

/** Information matrix of an edge as mrpt::graphslam::optimize_graph_spa_levmarq() weights it.
 *
 * An edge's cov_inv is documented, saved and composed in (x, y, z, yaw, pitch, roll). But that
 * optimiser (MRPT 2.5.8) multiplies it with the logarithm of the error, (x, y, z, rx, ry, rz) in
 * the frame of the edge's end, so yaw's weight meets the rotation about x. Assign the result to
 * edge.cov_inv before optimising. \throws std::invalid_argument if the covariance is not positive
 * definite */
[[nodiscard]] mrpt::math::CMatrixDouble66 optimizerInformation(
    const mrpt::poses::CPose3DPDFGaussian& edge);

/** Seconds since 1970, UTC; NaN for MRPT's INVALID_TIMESTAMP. */
[[nodiscard]] double toSeconds(mrpt::Clock::time_point stamp);
/** The inverse. Seconds that MRPT's clock cannot tell become the nearest that it can. */
[[nodiscard]] mrpt::Clock::time_point fromSeconds(double seconds);

/** Exact decimal text of a stamp in seconds since 1970: nine decimals, of which MRPT's clock (100
 * ns) fills seven. */
[[nodiscard]] std::string stampText(mrpt::Clock::time_point stamp);
/** The inverse for stamps since 1970; exact to 100 ns. \throws InputError if the text is not a
 * decimal number, has a sign, or more digits before the point than kLatestStamp */
[[nodiscard]] mrpt::Clock::time_point stampFromText(const std::string& text);
/** @} */
}  // namespace pointplane
