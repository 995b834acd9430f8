// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <utility>

namespace pointplane
{
/** Which part of the view a point is in: column and row of a grid on the plane at distance one.
 * \param p_cam in the camera, z > 0 \param side of a cell */
[[nodiscard]] inline std::pair<int, int> viewCell(const Eigen::Vector3d& p_cam, double side)
{
    const Eigen::Vector2d cell = p_cam.head<2>() / (p_cam.z() * side);
    return {static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y()))};
}
}  // namespace pointplane
