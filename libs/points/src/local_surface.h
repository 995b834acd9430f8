// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/points/PointFeature.h>
#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
/** How a point moves on the surface that the depth image shows around it when its pixel moves:
 * d p_cam / d uv [m/px], from a plane in inverse depth through the 7x7 readings. */
[[nodiscard]] Eigen::Matrix<double, 3, 2> surfaceJacobian(
    const RgbdFrame& frame, const PointFeature& point);

/** The depth jumps by more than a tenth somewhere within 9 pixels: a patch there shows two surfaces
 * that move against each other. Pixels without depth are no jump. */
[[nodiscard]] bool isNearDepthJump(const RgbdFrame& frame, const PointFeature& point);
}  // namespace pointplane
