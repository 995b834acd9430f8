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
 * the camera frame [m/s, rad/s], constant over the readout. A pixel is exposed at s =
 * delay + f readout with f = readoutFraction(). */
class ShutterCorrection
{
 public:
    /** Unknown times count as zero. */
    ShutterCorrection(const ShutterModel& shutter, const cv::Size& image);

    /** dP / dV [s, m s] of a point P as it was measured: at the frame's instant it is at
     * P + (dP / dV) V. Its pixel is from the colour image, exposed at s_c. Its depth is from the
     * depth image, exposed at s_d, which saw another part of the surface. To first order (dP / dV)
     * V = (s_c - s_d) theta_m^T (rho + omega x P) P + s_c (rho + omega x P). */
    [[nodiscard]] Matrix36d pointJacobian(const PointFeature& point) const;

    /** dtheta_m / dV of a plane as it was measured: at the frame's instant it is at
     * theta_m - (delay I + readout L) g with g = theta x omega - theta theta^T rho and L the
     * plane's readoutLever. Derivation: docs/theory.md, Rolling shutter. */
    [[nodiscard]] Matrix36d planeJacobian(const PlaneFeature& plane) const;

    /** How the two corrections (Jacobian times V) change with readoutColour, readoutDepth and
     * depthDelay, per second. The values of these times do not matter: corrections are linear. */
    [[nodiscard]] Eigen::Matrix3d pointByShutter(
        const PointFeature& point, const Vector6d& velocity) const;
    [[nodiscard]] Eigen::Matrix3d planeByShutter(
        const PlaneFeature& plane, const Vector6d& velocity) const;

 private:
    ShutterModel shutter_;
    cv::Size image_;
};
}  // namespace pointplane
