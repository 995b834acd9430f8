// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/uncertainty/JointCovariance.h>
#include <pointplane/odometry/uncertainty/ShutterCalibrator.h>
#include <pointplane/pose/pairs.h>
#include <pointplane/sensor/PinholeCamera.h>

namespace pointplane
{
/** Covariance of the camera's errors before the first frame. Nominal intrinsics are known as well
 * as cameras of one model are alike. */
[[nodiscard]] CameraMatrix cameraCovariance(
    const JointCovariance::TParams& calibration,
    const ShutterCalibrator::TParams& shutter,
    const PinholeCamera& camera);

/** How a point that was lifted with the camera's calibration moves with errors of that: if the true
 * focal length is larger, the point is nearer to the optical axis. \param p_cam in it [m]
 * \return [m]; the columns of the vignetting, by which its track moves, and of the shutter are zero
 */
[[nodiscard]] ByCamera pointByCamera(const Eigen::Vector3d& p_cam, const PinholeCamera& camera);

/** How a plane moves that was fitted to the inverse depths of pixels, q = r(u, v) . theta with the
 * ray r of the pixel. \param theta_m in the camera [1/m] \return [1/m] */
[[nodiscard]] ByCamera planeByCamera(const Eigen::Vector3d& theta_m, const PinholeCamera& camera);
}  // namespace pointplane
