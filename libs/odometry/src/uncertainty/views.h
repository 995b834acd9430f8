// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace pointplane
{
/** How far a motion changes what is seen: 1 for another view of the scene. */
[[nodiscard]] double numViews(const Eigen::Isometry3d& motion);
}  // namespace pointplane
