// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/points/PointFeature.h>
#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
/** The surface that the depth image shows around a point, as a plane through it: theta_m with
 * theta_m . P + 1 = 0 [1/m], from the inverse depths within 6 pixels. Level where there are not
 * enough. */
[[nodiscard]] Eigen::Vector3d localSurface(const RgbdFrame& frame, const PointFeature& point);

/** How a point moves on its surface when its pixel moves: d p_cam / d uv [m/px]. */
[[nodiscard]] Eigen::Matrix<double, 3, 2> surfaceJacobian(
    const PinholeCamera& camera, const PointFeature& point);

/** How the image of a point's surface moves with the reference's: d uv_cur / d uv_ref, without lens
 * distortion. \pre the point is before both cameras */
[[nodiscard]] Eigen::Matrix2d surfaceWarp(
    const PinholeCamera& camera, const PointFeature& reference, const Eigen::Isometry3d& T_cur_ref);

/** The depth jumps by more than a tenth somewhere within 9 pixels: a patch there shows two surfaces
 * that move against each other. Pixels without depth are no jump. */
[[nodiscard]] bool isNearDepthJump(const RgbdFrame& frame, const PointFeature& point);
}  // namespace pointplane
