// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <utility>

namespace pointplane
{
/** Side of the cells of a view, on the plane at distance one: 6 degrees. */
constexpr double kViewCell = 0.1;

/** Which cell of the view a point is in: column and row. \param p_cam in the camera, z > 0 */
[[nodiscard]] inline std::pair<int, int> viewCell(const Eigen::Vector3d& p_cam)
{
    const Eigen::Vector2d cell = p_cam.head<2>() / (p_cam.z() * kViewCell);
    return {static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y()))};
}
}  // namespace pointplane
