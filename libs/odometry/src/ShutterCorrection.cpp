// SPDX-License-Identifier: BSD-3-Clause
#include "ShutterCorrection.h"

#include <pointplane/core/se3.h>
#include <pointplane/sensor/readout.h>

#include <cmath>

namespace pointplane
{
namespace
{
/** From V to the velocity of a point in the camera's frame. */
Matrix36d pointVelocity(const Eigen::Vector3d& P)
{
    Matrix36d out;
    out << Eigen::Matrix3d::Identity(), -hat(P);
    return out;
}

/** From V to g. */
Matrix36d planeVelocity(const Eigen::Vector3d& theta)
{
    Matrix36d out;
    out << -theta * theta.transpose(), hat(theta);
    return out;
}

double known(double seconds) { return std::isfinite(seconds) ? seconds : 0; }
}  // namespace

ShutterCorrection::ShutterCorrection(const ShutterModel& shutter, const cv::Size& image)
    : shutter_{known(shutter.readoutColour), known(shutter.readoutDepth), known(shutter.depthDelay)},
      image_(image)
{
}

Matrix36d ShutterCorrection::pointJacobian(const PointFeature& point) const
{
    const double f = readoutFraction(point.uv_px, image_);
    const double sColour = f * shutter_.readoutColour;
    const double sDepth = shutter_.depthDelay + f * shutter_.readoutDepth;
    const Eigen::Vector3d& P = point.p_cam.mean;
    const Matrix36d velocity = pointVelocity(P);
    return sColour * velocity + (sColour - sDepth) * P * (point.theta_m.transpose() * velocity);
}

Matrix36d ShutterCorrection::planeJacobian(const PlaneFeature& plane) const
{
    const Matrix36d g = planeVelocity(plane.plane_cam.theta_m);
    return -(shutter_.depthDelay * g + shutter_.readoutDepth * (plane.readoutLever * g));
}

Eigen::Matrix3d ShutterCorrection::pointByShutter(
    const PointFeature& point, const Vector6d& velocity) const
{
    const double f = readoutFraction(point.uv_px, image_);
    const Eigen::Vector3d& P = point.p_cam.mean;
    const Eigen::Vector3d moved = pointVelocity(P) * velocity;
    const Eigen::Vector3d nearer = P * point.theta_m.dot(moved);
    Eigen::Matrix3d out;
    out << f * (moved + nearer), -f * nearer, -nearer;
    return out;
}

Eigen::Matrix3d ShutterCorrection::planeByShutter(
    const PlaneFeature& plane, const Vector6d& velocity) const
{
    const Eigen::Vector3d g = planeVelocity(plane.plane_cam.theta_m) * velocity;
    Eigen::Matrix3d out;
    out << Eigen::Vector3d::Zero(), -plane.readoutLever * g, -g;
    return out;
}
}  // namespace pointplane
