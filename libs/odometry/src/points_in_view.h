// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <vector>

#include "Reference.h"

namespace pointplane
{
/** Points of a reference that are due and in view of a camera. */
[[nodiscard]] int numInView(
    const Reference& reference, const PinholeCamera& camera, const Eigen::Isometry3d& T_cur_ref);

/** Whether half of the points were found in the outer half of the radius around where they were
 * searched for: then there are others beyond it.
 * \param T_cur_world by which they were searched for */
[[nodiscard]] bool areNearEdge(
    const std::vector<Association>& associations,
    const PinholeCamera& camera,
    const Eigen::Isometry3d& T_cur_world,
    double radius_px);
}  // namespace pointplane
