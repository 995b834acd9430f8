// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/camera_errors.h>

#include <algorithm>

namespace pointplane
{
namespace
{
/** What cameras of one model differ by, where nobody calibrated this one: focal length, and the
 * principal point over the width of the image. */
constexpr double kNominal = 0.02;
}  // namespace

CameraMatrix cameraCovariance(
    const JointCovariance::TParams& calibration,
    const ShutterCalibrator::TParams& shutter,
    const PinholeCamera& camera)
{
    const double time = shutter.correct && shutter.selfCalibrate ? shutter.sigmaPrior : 0;
    double centre = calibration.principalPoint, focalLength = calibration.focalLength;
    if (camera.isNominal)
    {
        centre = std::max(centre, kNominal * camera.width);
        focalLength = std::max(focalLength, kNominal);
    }
    CameraVector sigmas;
    sigmas << calibration.vignetting, centre, centre, focalLength, calibration.depthScale, time,
        time, time;
    return sigmas.cwiseAbs2().asDiagonal();
}

ByCamera pointByCamera(const Eigen::Vector3d& p_cam, const PinholeCamera& camera)
{
    ByCamera out = ByCamera::Zero();
    out.leftCols<kFirstShutterError>() << Eigen::Vector3d::Zero(),
        Eigen::Vector3d(-p_cam.z() / camera.fx, 0, 0),
        Eigen::Vector3d(0, -p_cam.z() / camera.fy, 0), Eigen::Vector3d(-p_cam.x(), -p_cam.y(), 0),
        p_cam;
    return out;
}

ByCamera planeByCamera(const Eigen::Vector3d& theta_m, const PinholeCamera& camera)
{
    ByCamera out = ByCamera::Zero();
    out.leftCols<kFirstShutterError>() << Eigen::Vector3d::Zero(),
        Eigen::Vector3d(0, 0, theta_m.x() / camera.fx),
        Eigen::Vector3d(0, 0, theta_m.y() / camera.fy),
        Eigen::Vector3d(theta_m.x(), theta_m.y(), 0), -theta_m;
    return out;
}
}  // namespace pointplane
