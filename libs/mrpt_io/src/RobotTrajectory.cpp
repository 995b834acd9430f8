// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/mrpt_io/RobotTrajectory.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <algorithm>

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
    if (!hasBegun_)
    {
        // The robot has not moved yet, whatever its camera did on it.
        T_robot_cam_first_ = T_robot_cam;
        T_robot_cam_.assign(1, T_robot_cam);
        hasBegun_ = result.status == TrackingStatus::First;
    }
    RobotMotion out;
    out.status = result.status;
    out.reason = result.reason;
    out.diagnostics = result.diagnostics;
    out.cameraPose = result.pose;
    out.increment = toMrpt(onRobot(T_robot_cam_.front(), result.increment, T_robot_cam));
    out.pose = toMrpt(onRobot(T_robot_cam_first_, result.pose, T_robot_cam));
    for (std::size_t k = 0; k < std::min(result.since.size(), T_robot_cam_.size()); ++k)
    {
        out.since.push_back(toMrpt(onRobot(T_robot_cam_[k], result.since[k], T_robot_cam)));
    }
    T_robot_cam_.push_front(T_robot_cam);
    T_robot_cam_.resize(std::min(T_robot_cam_.size(), result.since.size() + 2));
    return out;
}

RobotMotion RobotTrajectory::add(const OdometryResult& result)
{
    return add(result, Eigen::Isometry3d(T_robot_cam_.front()));
}
}  // namespace pointplane
