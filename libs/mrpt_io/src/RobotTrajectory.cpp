// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/mrpt_io/RobotTrajectory.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <algorithm>

namespace pointplane
{
/** T_ra_rb = T_ra_ca * T_ca_cb * T_rb_cb^-1, the camera's poses on the robot being exact. A
 * predicted motion of the camera may be with the robot alone: how far the camera has moved on it
 * since the latest measured frame is a standard deviation. */
PoseGaussian RobotTrajectory::onRobot(const Mount& a, const PoseGaussian& T_ca_cb, const Mount& b)
{
    const Eigen::Isometry3d mean = a.T_robot_cam * T_ca_cb.mean * b.T_robot_cam.inverse();
    Matrix6d cov = propagate(adjoint(a.T_robot_cam), T_ca_cb.cov);
    const auto hasMoved = [](const Mount& mount)
    { return mount.T_robot_cam.matrix() != mount.T_robot_cam_measured.matrix(); };
    if (hasMoved(a) || hasMoved(b))
    {
        const Vector6d doubt = se3Log(
            a.T_robot_cam_measured * T_ca_cb.mean * b.T_robot_cam_measured.inverse() *
            mean.inverse());
        cov += doubt * doubt.transpose();
    }
    return {orthonormalised(mean), cov};
}

RobotMotion RobotTrajectory::add(const OdometryResult& result, const Eigen::Isometry3d& T_robot_cam)
{
    Mount mount{T_robot_cam, mounts_.front().T_robot_cam_measured};
    if (!hasBegun_ || isMeasured(result.status))
    {
        mount.T_robot_cam_measured = T_robot_cam;
    }
    if (!hasBegun_)
    {
        // The robot has not moved yet, whatever its camera did on it.
        first_ = mount;
        mounts_.assign(1, mount);
        hasBegun_ = result.status == TrackingStatus::First;
    }
    RobotMotion out;
    out.status = result.status;
    out.stamp = result.stamp;
    out.reason = result.reason;
    out.diagnostics = result.diagnostics;
    out.cameraPose = result.pose;
    out.increment = toMrpt(onRobot(mounts_.front(), result.increment, mount));
    out.pose = toMrpt(onRobot(first_, result.pose, mount));
    for (std::size_t k = 0; k < std::min(result.since.size(), mounts_.size()); ++k)
    {
        out.since.push_back(toMrpt(onRobot(mounts_[k], result.since[k], mount)));
    }
    mounts_.push_front(mount);
    mounts_.resize(std::min(mounts_.size(), result.since.size() + 2), first_);
    return out;
}

RobotMotion RobotTrajectory::add(const OdometryResult& result)
{
    return add(result, Eigen::Isometry3d(mounts_.front().T_robot_cam));
}
}  // namespace pointplane
