// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/VisualOdometry.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/mrpt_io/params_ini.h>

namespace pointplane
{
VisualOdometry::VisualOdometry(const TParams& params)
    : mrpt::system::COutputLogger("pointplane"), odometry_(params)
{
}

void VisualOdometry::loadFromConfigFileName(const std::string& path)
{
    odometry_ = Odometry(loadOdometryParams(path));
    trajectory_.reset();
}

RobotMotion VisualOdometry::process(const mrpt::obs::CObservation3DRangeScan& scan)
{
    const ConvertedFrame converted = converter_.convert(scan);
    const bool usable = converted.problem.empty();
    const OdometryResult result = odometry_.process(converted.frame);
    RobotMotion motion =
        usable ? trajectory_.add(result, converted.T_robot_cam) : trajectory_.add(result);
    if (!usable)
    {
        motion.reason = converted.problem;
    }
    if (motion.status == TrackingStatus::Predicted || motion.status == TrackingStatus::Lost)
    {
        MRPT_LOG_WARN_STREAM(
            stampText(scan.timestamp) << ": " << toString(motion.status) << ": " << motion.reason);
    }
    MRPT_LOG_DEBUG_STREAM(
        stampText(scan.timestamp) << ": " << toString(motion.status) << " "
                                  << motion.pose.mean.asString());
    return motion;
}

void VisualOdometry::reset()
{
    odometry_.reset();
    trajectory_.reset();
}
}  // namespace pointplane
