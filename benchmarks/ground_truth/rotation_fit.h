// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pointplane
{
/** A point whose place is known, and where a camera sees it. */
struct Sighting
{
    Eigen::Vector3d p_cam{0, 0, 1};  //!< where it should be [m]
    Eigen::Vector2d seen{0, 0};      //!< normalised image coordinates of where it is
    double row{0};                   //!< of that, from -1/2 (top) to 1/2 (bottom)
};

/** Rotation vector omega [rad], in camera axes, for which the points exp(omega) * p_cam are where
 * they are seen: robust least squares (Tukey's weights, scale from the residuals). A second
 * rotation that grows with the row is estimated with it: under a rolling shutter a trembling hand
 * shears the image, which otherwise looks like a rotation about the optical axis. Nothing with
 * fewer than ten sightings or when they do not determine both. */
[[nodiscard]] std::optional<Eigen::Vector3d> fitRotation(const std::vector<Sighting>& sightings);
}  // namespace pointplane
