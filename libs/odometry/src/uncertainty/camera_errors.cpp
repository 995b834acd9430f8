// SPDX-License-Identifier: BSD-3-Clause
#include "camera_errors.h"

#include <algorithm>

namespace pointplane
{
namespace
{
/** Mean squared distance of the image's pixels from its centre, over the focal length: of the
 * normalised radius. */
double meanSquaredRadius(const PinholeCamera& camera)
{
    const double width = camera.width / camera.fx, height = camera.height / camera.fy;
    return (width * width + height * height) / 12;
}
}  // namespace

CameraVector lensVariances(const PinholeCamera& camera, double bend)
{
    CameraVector sigmas = CameraVector::Zero();
    // A lens that turns rays by the part e of their angle has k1 r^2 = e.
    sigmas[kRadial] = bend / meanSquaredRadius(camera);
    if (camera.isNominal)
    {
        sigmas[kPrincipalPointX] = sigmas[kPrincipalPointY] =
            PinholeCamera::kNominal * camera.width;
        sigmas[kFocalLength] = PinholeCamera::kNominal;
        sigmas[kRadial] = std::max(bend, PinholeCamera::kNominal) / meanSquaredRadius(camera);
    }
    return sigmas.cwiseAbs2();
}

CameraVector calibrationVariances(const CovarianceParams& calibration, const PinholeCamera& camera)
{
    CameraVector sigmas;
    sigmas << calibration.vignetting, calibration.principalPoint, calibration.principalPoint,
        calibration.focalLength, 0, calibration.depthScale, 0, 0, 0;
    return sigmas.cwiseAbs2().cwiseMax(lensVariances(camera, 0));
}

ByCamera pointByCamera(const Eigen::Vector3d& p_cam, const PinholeCamera& camera)
{
    const double z = p_cam.z(), squaredRadius = p_cam.head<2>().squaredNorm() / (z * z);
    const Eigen::Vector3d inwards(-p_cam.x(), -p_cam.y(), 0);
    ByCamera out = ByCamera::Zero();
    out.col(kPrincipalPointX) << -z / camera.fx, 0, 0;
    out.col(kPrincipalPointY) << 0, -z / camera.fy, 0;
    out.col(kFocalLength) = inwards;
    out.col(kRadial) = squaredRadius * inwards;
    out.col(kDepthScale) = p_cam;
    return out;
}

ByCamera planeByCamera(const Eigen::Vector3d& theta_m, const PinholeCamera& camera)
{
    ByCamera out = ByCamera::Zero();
    out.col(kPrincipalPointX) << 0, 0, theta_m.x() / camera.fx;
    out.col(kPrincipalPointY) << 0, 0, theta_m.y() / camera.fy;
    out.col(kFocalLength) << theta_m.x(), theta_m.y(), 0;
    out.col(kDepthScale) = -theta_m;
    return out;
}
}  // namespace pointplane
