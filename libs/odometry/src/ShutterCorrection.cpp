// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/odometry/ShutterCorrection.h>

#include <cmath>

namespace pointplane
{
namespace
{
double known(double seconds) { return std::isfinite(seconds) ? seconds : 0; }
}  // namespace

ShutterCorrection::ShutterCorrection(const ShutterModel& shutter, int imageHeight)
    : shutter_{known(shutter.readoutColour), known(shutter.readoutDepth), known(shutter.depthDelay)},
      height_(imageHeight)
{
}

Matrix36d ShutterCorrection::pointJacobian(const PointFeature& point) const
{
    const double f = point.uv_px.y() / height_ - 0.5;
    const double sColour = f * shutter_.readoutColour;
    const double sDepth = shutter_.depthDelay + f * shutter_.readoutDepth;
    const Eigen::Vector3d& P = point.p_cam.mean;
    Matrix36d velocity;  // of the point in the camera's frame, from V
    velocity << Eigen::Matrix3d::Identity(), -hat(P);
    return sColour * velocity + (sColour - sDepth) * P * (point.theta_m.transpose() * velocity);
}

Matrix36d ShutterCorrection::planeJacobian(const PlaneFeature& plane) const
{
    const Eigen::Vector3d& theta = plane.plane_cam.theta_m;
    Matrix36d g;
    g << -theta * theta.transpose(), hat(theta);
    return -(shutter_.depthDelay * g + shutter_.readoutDepth * (plane.rowLever * g));
}
}  // namespace pointplane
