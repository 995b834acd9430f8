// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/planes/PlaneFeature.h>
#include <pointplane/points/PointFeature.h>
#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
/** Moves what a rolling shutter saw to the instant of the pose, given the camera's velocity.
 *
 * The camera moves as T_world_cam(t) = T_world_cam(stamp) exp((t - stamp) V), V = [rho; omega] in
 * the camera frame [m/s, rad/s], constant over the readout. Row v of height h is exposed at s =
 * delay + f readout with f = v/h - 1/2 (sensor/RgbdFrame.h). */
class ShutterCorrection
{
 public:
    /** Unknown times count as zero. */
    ShutterCorrection(const ShutterModel& shutter, int imageHeight);

    /** dP / dV of a point whose pixel is from the colour image and whose depth is from the depth
     * image, which saw another part of its surface there: what was at P when it was seen is at
     * P + (dP / dV) V at the frame's instant, to first order
     * P + (s_c - s_d) theta_m^T (rho + omega x P) P + s_c (rho + omega x P). */
    [[nodiscard]] Matrix36d pointJacobian(const PointFeature& point) const;

    /** dtheta_m / dV of a plane: theta_m - (delay I + readout L) g with g = theta x omega - theta
     * theta^T rho and L the plane's rowLever; derivation in docs/theory.md. */
    [[nodiscard]] Matrix36d planeJacobian(const PlaneFeature& plane) const;

    /** How these two times V change with readoutColour, readoutDepth, depthDelay [1/s], whatever
     * they are. */
    [[nodiscard]] Eigen::Matrix3d pointByShutter(
        const PointFeature& point, const Vector6d& velocity) const;
    [[nodiscard]] Eigen::Matrix3d planeByShutter(
        const PlaneFeature& plane, const Vector6d& velocity) const;

 private:
    ShutterModel shutter_;
    double height_;
};
}  // namespace pointplane
