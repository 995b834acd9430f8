// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Plane.h>
#include <pointplane/planes/PlaneMoments.h>
#include <pointplane/sensor/DepthNoise.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pointplane
{
/** Fits a plane to inverse depths of constant noise: Sigma_m = sigma^2 (sum w r r^T)^-1 [1/m^2].
 * sigma is noise.sigmaInverseDepth or, when larger, that of the residuals. Pixels count as
 * independent.
 * \param moments weighted by CellGrid::weigh()
 * \return nothing when the pixels do not span a plane */
[[nodiscard]] std::optional<PlaneGaussian> fitInverseDepth(
    const PlaneMoments& moments, const DepthNoise& noise);

/** Fits a plane as the paper does: minimises sum w_i (theta_m . P_i + 1)^2 / 2 with w_i =
 * sigma_Z^-2, by theta_m = A^-1 b, Sigma_m = A^-1 [P17 Eq. 3, 4, 5]. Sigma_m depends on the unit of
 * length, because w_i is 1 / length^2 but theta_m . P_i + 1 has no unit. Here it is the millimetre,
 * in which the paper gives sigma_Z; with metres Sigma_m would be a million times smaller. \param
 * points on the plane, camera frame [m] \return theta_m [1/m]; nothing when the points do not span
 * a plane */
[[nodiscard]] std::optional<PlaneGaussian> fitWeightedLeastSquares(
    const std::vector<Eigen::Vector3d>& points, const DepthNoise& noise);

/** Finds the plane through three of the points that most others agree with, in a fixed number of
 * seeded draws.
 * \param points camera frame [m] \param maxSigmas largest distance, in sigma_Z
 * \return indices of the points that agree; all if there are fewer than 3 or every draw is
 * degenerate */
[[nodiscard]] std::vector<std::size_t> ransacInliers(
    const std::vector<Eigen::Vector3d>& points,
    const DepthNoise& noise,
    double maxSigmas,
    int draws,
    std::uint32_t seed);
}  // namespace pointplane
