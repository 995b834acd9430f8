// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/core/PointGaussian.h>
#include <pointplane/planes/PlaneFeature.h>
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

    /** A point whose pixel is from the colour image and whose depth is from the depth image:
     * P_c = P - (s_c - s_d) (rho + omega x P)_z (x, y, 1), then P_c + s_c (rho + omega x P_c).
     * \param row of the pixel \param V body velocity [m/s, rad/s] */
    [[nodiscard]] Eigen::Vector3d point(
        const Eigen::Vector3d& P, double row, const Vector6d& V) const;

    /** A plane: theta_m - (delay I + readout L) g with g = theta x omega - (theta . rho) theta and
     * L the plane's rowLever; derivation in docs/theory.md. The covariance is kept. */
    [[nodiscard]] PlaneGaussian plane(const PlaneFeature& plane, const Vector6d& V) const;

 private:
    ShutterModel shutter_;
    double height_;
};
}  // namespace pointplane
