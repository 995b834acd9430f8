// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/mrpt_io/VisualOdometry.h>
#include <pointplane/mrpt_io/params_ini.h>

#include <utility>

#include "scan_images.h"

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
    reset();
}

RobotMotion VisualOdometry::process(const mrpt::obs::CObservation3DRangeScan& scan)
{
    return process(converter_.convert(scan));
}

RobotMotion VisualOdometry::process(const ConvertedFrame& converted)
{
    ConvertedFrame own = ofOneCamera(converted, label_);
    if (own.problem.empty())
    {
        own.problem = problemOfPose(own.T_robot_cam, "T_robot_cam");
    }
    const bool usable = own.problem.empty();
    if (!usable)
    {
        RgbdFrame none;
        none.stamp = own.frame.stamp;
        own.frame = none;
    }
    const OdometryResult result = odometry_.process(own.frame);
    RobotMotion motion =
        usable ? trajectory_.add(result, own.T_robot_cam) : trajectory_.add(result);
    if (!usable)
    {
        motion.reason = own.problem;
    }
    const auto stamp = [&] { return numberText(own.frame.stamp, 6); };
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
    converter_.reset();
    trajectory_.reset();
    label_.reset();
}
}  // namespace pointplane
