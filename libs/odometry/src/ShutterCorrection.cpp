// SPDX-License-Identifier: BSD-3-Clause
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

Eigen::Vector3d ShutterCorrection::point(
    const Eigen::Vector3d& P, double row, const Vector6d& V) const
{
    const double f = row / height_ - 0.5;
    const double sColour = f * shutter_.readoutColour;
    const double sDepth = shutter_.depthDelay + f * shutter_.readoutDepth;
    const auto velocity = [&V](const Eigen::Vector3d& p) -> Eigen::Vector3d
    { return V.head<3>() + V.tail<3>().cross(p); };
    const double z = P.z() - (sColour - sDepth) * velocity(P).z();
    const Eigen::Vector3d P_colour = P * (z / P.z());
    return P_colour + sColour * velocity(P_colour);
}

PlaneGaussian ShutterCorrection::plane(const PlaneFeature& plane, const Vector6d& V) const
{
    PlaneGaussian out = plane.plane_cam;
    const Eigen::Vector3d& theta = plane.plane_cam.theta_m;
    const Eigen::Vector3d g = theta.cross(V.tail<3>()) - theta.dot(V.head<3>()) * theta;
    out.theta_m -= shutter_.depthDelay * g + shutter_.readoutDepth * (plane.rowLever * g);
    return out;
}
}  // namespace pointplane
