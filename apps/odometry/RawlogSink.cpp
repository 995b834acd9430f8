// SPDX-License-Identifier: BSD-3-Clause
#include "RawlogSink.h"

#include <pointplane/mrpt_io/SimplemapWriter.h>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>

namespace pointplane
{
namespace
{
[[nodiscard]] mrpt::obs::CObservationRobotPose::Ptr poseObservation(const OutputItem& item)
{
    auto out = mrpt::obs::CObservationRobotPose::Create();
    out->sensorLabel = item.source.observation->sensorLabel + "_pose";
    out->timestamp = item.source.observation->timestamp;
    out->pose = item.frame->motion.pose;
    return out;
}

[[nodiscard]] bool isTracked(const RobotMotion& motion)
{
    return motion.status == TrackingStatus::First || motion.status == TrackingStatus::Tracked;
}

/** CObservationComment keeps no label of its own, so the text names it. */
[[nodiscard]] mrpt::obs::CObservationComment::Ptr statusComment(const OutputItem& item)
{
    auto out = mrpt::obs::CObservationComment::Create();
    out->timestamp = item.source.observation->timestamp;
    const RobotMotion& motion = item.frame->motion;
    out->text = "pointplane-status label=" + item.source.observation->sensorLabel +
                " frame=" + std::to_string(item.source.frameIndex) + " " + toString(motion.status) +
                (motion.reason.empty() ? "" : ": " + motion.reason);
    return out;
}
}  // namespace

RawlogSink::RawlogSink(const OdometryOptions& options)
    : writer_(options.output),
      format1_(options.format1),
      onlyPoses_(options.onlyPoses),
      withPoints_(options.withPoints)
{
}

void RawlogSink::add(const OutputItem& item)
{
    if (format1_)
    {
        addFormat1(item);
    }
    else
    {
        addFormat2(item);
    }
}

mrpt::obs::CObservation::Ptr RawlogSink::observationOf(const OutputItem& item) const
{
    if (withPoints_ && item.frame && item.source.converted->problem.empty())
    {
        return withPoints(
            dynamic_cast<const mrpt::obs::CObservation3DRangeScan&>(*item.source.observation));
    }
    return item.source.observation;
}

void RawlogSink::addFormat2(const OutputItem& item)
{
    if (!onlyPoses_)
    {
        writer_.write(*observationOf(item));
    }
    if (item.frame)
    {
        writer_.write(*poseObservation(item));
        if (!isTracked(item.frame->motion))
        {
            writer_.write(*statusComment(item));
        }
    }
}

void RawlogSink::addFormat1(const OutputItem& item)
{
    if (!item.frame)
    {
        return;  // other sensors have no place between actions
    }
    mrpt::obs::CActionRobotMovement3D movement;
    movement.timestamp = item.source.observation->timestamp;
    movement.estimationMethod = mrpt::obs::CActionRobotMovement3D::emVisualOdometry;
    movement.poseChange = item.frame->motion.increment;
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    writer_.write(actions);

    mrpt::obs::CSensoryFrame frame;
    if (!onlyPoses_)
    {
        frame.insert(observationOf(item));
    }
    frame.insert(poseObservation(item));
    if (!isTracked(item.frame->motion))
    {
        frame.insert(statusComment(item));
    }
    writer_.write(frame);
}

void RawlogSink::close() { writer_.close(); }

std::string RawlogSink::description() const
{
    return writer_.path() + ": " + std::to_string(writer_.numObjects()) + " objects, format " +
           (format1_ ? "1" : "2");
}
}  // namespace pointplane
