// SPDX-License-Identifier: BSD-3-Clause
#include "local_surface.h"

#include <Eigen/Cholesky>
#include <opencv2/core.hpp>

#include <cmath>

namespace pointplane
{
namespace
{
/** Calls f(du, dv, z) for readings around a point's pixel of the depth image. */
template <class F>
void forEachReading(const RgbdFrame& frame, const PointFeature& point, int radius, int step, F f)
{
    const Eigen::Vector2d pixel = frame.camera.depthPixel(point.uv_px);
    const cv::Point centre(cvRound(pixel.x()), cvRound(pixel.y()));
    const cv::Rect image(0, 0, frame.depth.cols, frame.depth.rows);
    for (int dv = -radius; dv <= radius; dv += step)
    {
        for (int du = -radius; du <= radius; du += step)
        {
            const cv::Point at = centre + cv::Point(du, dv);
            const double z =
                image.contains(at) ? static_cast<double>(frame.depth.at<float>(at)) : 0;
            if (z > 0)  // false for NaN
            {
                f(du, dv, z);
            }
        }
    }
}
}  // namespace

Eigen::Vector3d localSurface(const RgbdFrame& frame, const PointFeature& point)
{
    constexpr double kSameSurface = 0.05;  // relative difference of depth
    constexpr int kRadius = 6, kStep = 2;
    constexpr double kLeastReadings = 8;
    const Eigen::Vector3d& p = point.p_cam.mean;

    // Least squares of 1/Z over (1, du, dv), with a weak preference for a level surface.
    Eigen::Matrix3d A = Eigen::Vector3d(0, 1, 1).asDiagonal();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    forEachReading(
        frame,
        point,
        kRadius,
        kStep,
        [&](int du, int dv, double z)
        {
            if (std::abs(p.z() / z - 1) < kSameSurface)
            {
                const Eigen::Vector3d x(1, du, dv);
                A += x * x.transpose();
                b += x / z;
            }
        });
    Eigen::Vector2d slope(0, 0);  // of 1/Z [1/m per px]
    if (A(0, 0) >= kLeastReadings)
    {
        slope = A.ldlt().solve(b).tail<2>();
    }
    Eigen::Vector3d theta(-slope.x() * frame.camera.fx, -slope.y() * frame.camera.fy, 0);
    theta.z() = (-1 - theta.head<2>().dot(p.head<2>())) / p.z();
    return theta;
}

Eigen::Matrix<double, 3, 2> surfaceJacobian(const PinholeCamera& camera, const PointFeature& point)
{
    const Eigen::Vector3d& p = point.p_cam.mean;
    Eigen::Matrix<double, 3, 2> ray;  // p.z() times that of the ray through the pixel
    ray << p.z() / camera.fx, 0, 0, p.z() / camera.fy, 0, 0;
    return ray + p * (point.theta_m.transpose() * ray);
}

Eigen::Matrix2d surfaceWarp(
    const PinholeCamera& camera, const PointFeature& reference, const Eigen::Isometry3d& T_cur_ref)
{
    const Eigen::Vector3d p = T_cur_ref * reference.p_cam.mean;
    Eigen::Matrix<double, 2, 3> projection;
    projection << camera.fx, 0, -camera.fx * p.x() / p.z(), 0, camera.fy,
        -camera.fy * p.y() / p.z();
    return projection / p.z() * T_cur_ref.linear() * surfaceJacobian(camera, reference);
}

bool isNearDepthJump(const RgbdFrame& frame, const PointFeature& point)
{
    constexpr double kJump = 0.1;  // relative
    constexpr int kRadius = 9, kStep = 3;
    bool jump = false;
    forEachReading(
        frame,
        point,
        kRadius,
        kStep,
        [&](int, int, double z) { jump = jump || std::abs(point.p_cam.mean.z() / z - 1) > kJump; });
    return jump;
}
}  // namespace pointplane
