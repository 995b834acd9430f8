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
/** Plane with constant noise in inverse depth: Sigma_m = sigma^2 (sum w r r^T)^-1, where sigma is
 * noise.sigmaInverseDepth of a weighted pixel (CellGrid::weigh()) or, when larger, the residuals'.
 * Pixels count as independent. */
[[nodiscard]] std::optional<PlaneGaussian> fitInverseDepth(
    const PlaneMoments& moments, const DepthNoise& noise);

/** Plane of minimal sum w_i (theta_m . P_i + 1)^2 / 2, w_i = sigma_Z^-2, by theta_m = A^-1 b with
 * Sigma_m = A^-1 [P17 Eq. 3, 4, 5]. With these weights Sigma_m depends on the unit of length: w_i
 * is 1 / length^2, theta_m . P_i + 1 a bare number. As the paper gives sigma_Z, it is the
 * millimetre; in metres Sigma_m were a million times smaller. \param points on the plane, camera
 * frame [m] \return nothing when they do not span a plane */
[[nodiscard]] std::optional<PlaneGaussian> fitWeightedLeastSquares(
    const std::vector<Eigen::Vector3d>& points, const DepthNoise& noise);

/** Indices of the points within `maxSigmas` of the best plane through three of them, over a fixed
 * number of draws from a seeded generator; of all points when fewer than 3 or when every draw is
 * degenerate. */
[[nodiscard]] std::vector<std::size_t> ransacInliers(
    const std::vector<Eigen::Vector3d>& points,
    const DepthNoise& noise,
    double maxSigmas,
    int draws,
    std::uint32_t seed);
}  // namespace pointplane
