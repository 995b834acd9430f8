// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/mrpt_io/VisualOdometry.h>
#include <pointplane/mrpt_io/params_ini.h>

#include <limits>
#include <utility>

namespace pointplane
{
VisualOdometry::VisualOdometry(const TParams& params)
    : mrpt::system::COutputLogger("pointplane"), odometry_(params)
{
}

void VisualOdometry::loadFromConfigFileName(const std::string& path)
{
    Odometry odometry(loadOdometryParams(path));
    odometry.setMask(odometry_.mask());
    odometry_ = std::move(odometry);
    trajectory_.reset();
    label_.reset();
}

RobotMotion VisualOdometry::process(const mrpt::obs::CObservation3DRangeScan& scan)
{
    return process(converter_.convert(scan));
}

RobotMotion VisualOdometry::process(const ConvertedFrame& converted)
{
    label_ = label_.value_or(converted.sensorLabel);
    if (converted.sensorLabel == *label_)
    {
        return add(converted);
    }
    ConvertedFrame other;
    other.frame.stamp = std::numeric_limits<double>::quiet_NaN();  // it says nothing of this camera
    other.problem = "is of camera '" + converted.sensorLabel + "', not of '" + *label_ +
                    "': each camera needs an object of its own";
    return add(other);
}

RobotMotion VisualOdometry::add(const ConvertedFrame& converted)
{
    const bool usable = converted.problem.empty();
    const OdometryResult result = odometry_.process(converted.frame);
    RobotMotion motion =
        usable ? trajectory_.add(result, converted.T_robot_cam) : trajectory_.add(result);
    if (!usable)
    {
        motion.reason = converted.problem;
    }
    const auto stamp = [&] { return numberText(converted.frame.stamp, 6); };
    if (motion.status == TrackingStatus::Predicted || motion.status == TrackingStatus::Lost)
    {
        MRPT_LOG_WARN_STREAM(stamp() << ": " << toString(motion.status) << ": " << motion.reason);
    }
    MRPT_LOG_DEBUG_STREAM(
        stamp() << ": " << toString(motion.status) << " " << motion.pose.mean.asString());
    return motion;
}

void VisualOdometry::reset()
{
    odometry_.reset();
    trajectory_.reset();
    label_.reset();
}
}  // namespace pointplane
