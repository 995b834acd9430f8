// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/uncertainty/CovarianceParams.h>
#include <pointplane/pose/pairs.h>
#include <pointplane/sensor/PinholeCamera.h>

namespace pointplane
{
/** Variances of what is to be learnt of a lens. If it was calibrated: of radial distortion only, as
 * far as depth is bent. If the intrinsics are nominal: of all of them.
 * \param bend smooth error of depth, as a fraction of it (DepthNoise::sigmaRelative)
 * \return of principal point [px^2], focal length [relative] and radial distortion; others zero */
[[nodiscard]] CameraVector lensVariances(const PinholeCamera& camera, double bend);

/** Variances of the camera's errors before the first frame, zero of the shutter. If its intrinsics
 * are nominal, they are as uncertain as cameras of one model differ. */
[[nodiscard]] CameraVector calibrationVariances(
    const CovarianceParams& calibration, const PinholeCamera& camera);

/** Jacobian of a point by errors of the calibration by which it was lifted. (If the true focal
 * length is larger, the point is nearer to the optical axis.) \param p_cam point in the camera [m]
 * \return [m] per error; zero for vignetting, which moves tracks, and for the shutter */
[[nodiscard]] ByCamera pointByCamera(const Eigen::Vector3d& p_cam, const PinholeCamera& camera);

/** Jacobian of a plane by errors of the calibration by which it was fitted to inverse depths.
 * \param theta_m plane in the camera [1/m]
 * \return [1/m] per error; zero for vignetting, the shutter, and radial distortion, which bends it
 */
[[nodiscard]] ByCamera planeByCamera(const Eigen::Vector3d& theta_m, const PinholeCamera& camera);
}  // namespace pointplane
