// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/mrpt_io/RobotTrajectory.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

namespace pointplane
{
namespace
{
/** T_ra_rb = T_ra_ca * T_ca_cb * T_rb_cb^-1, the camera's poses on the robot being exact. */
[[nodiscard]] PoseGaussian onRobot(
    const Eigen::Isometry3d& T_ra_ca, const PoseGaussian& T_ca_cb, const Eigen::Isometry3d& T_rb_cb)
{
    return {
        orthonormalised(T_ra_ca * T_ca_cb.mean * T_rb_cb.inverse()),
        propagate(adjoint(T_ra_ca), T_ca_cb.cov)};
}
}  // namespace

RobotMotion RobotTrajectory::add(const OdometryResult& result, const Eigen::Isometry3d& T_robot_cam)
{
    if (!started_)
    {
        T_robot_cam_first_ = T_robot_cam_prev_ = T_robot_cam;
        started_ = true;
    }
    RobotMotion out;
    out.status = result.status;
    out.reason = result.reason;
    out.diagnostics = result.diagnostics;
    out.increment = toMrpt(onRobot(T_robot_cam_prev_, result.increment, T_robot_cam));
    out.pose = toMrpt(onRobot(T_robot_cam_first_, result.pose, T_robot_cam));
    T_robot_cam_prev_ = T_robot_cam;
    return out;
}

RobotMotion RobotTrajectory::add(const OdometryResult& result)
{
    return add(result, started_ ? T_robot_cam_prev_ : opticalInBody());
}
}  // namespace pointplane
