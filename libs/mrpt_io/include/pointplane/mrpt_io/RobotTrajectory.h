// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/odometry/OdometryResult.h>

#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <deque>
#include <string>
#include <vector>

namespace pointplane
{
/** One frame's result in the robot's frame, MRPT axes. */
struct RobotMotion
{
    TrackingStatus status{TrackingStatus::Lost};
    double stamp{0};                            //!< of the frame [s]; NaN: of another camera
    std::string reason;                         //!< why not tracked, or not in full; or empty
    mrpt::poses::CPose3DPDFGaussian increment;  //!< since the previous frame
    mrpt::poses::CPose3DPDFGaussian pose;       //!< since the first frame
    /** Since 1, 2, ... frames ago, up to OdometryParams::covariance.history (default: 1, the frame
     * before). Set it before the first frame. */
    std::vector<mrpt::poses::CPose3DPDFGaussian> since;
    PoseGaussian cameraPose;  //!< T_first_cam of the camera, optical axes
    FrameDiagnostics diagnostics;
};

/** Turns motions of the camera into motions of the robot that carries it. The camera may move on
 * the robot (a pan-tilt head), because each frame brings the camera's pose on it. Until the frame
 * that is First, the robot stands. */
class RobotTrajectory
{
 public:
    /** \param result motion of the camera, in its optical frame
     * \param T_robot_cam of this frame, optical axes; taken as exact */
    [[nodiscard]] RobotMotion add(
        const OdometryResult& result, const Eigen::Isometry3d& T_robot_cam);

    /** As add() for a frame whose camera pose is not known: that of the previous one is used.
     * Before any is known, the camera looks ahead from the robot's origin. */
    [[nodiscard]] RobotMotion add(const OdometryResult& result);

    void reset() { *this = RobotTrajectory(); }

 private:
    /** Where the camera is on the robot, optical axes. */
    struct Mount
    {
        Eigen::Isometry3d T_robot_cam;
        Eigen::Isometry3d T_robot_cam_measured;  //!< in the latest frame that was measured
    };
    [[nodiscard]] static PoseGaussian onRobot(
        const Mount& a, const PoseGaussian& T_ca_cb, const Mount& b);

    bool hasBegun_{false};  //!< there was a frame that is First
    Mount first_{opticalInBody(), opticalInBody()};
    std::deque<Mount> mounts_{first_};  //!< of the frames so far, latest first
};
}  // namespace pointplane
