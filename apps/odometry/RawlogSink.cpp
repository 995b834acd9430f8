// SPDX-License-Identifier: BSD-3-Clause
#include "RawlogSink.h"

#include <pointplane/core/counted.h>
#include <pointplane/mrpt_io/SimplemapWriter.h>
#include <pointplane/mrpt_io/output_labels.h>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <vector>

namespace pointplane
{
namespace
{
[[nodiscard]] mrpt::obs::CObservationRobotPose::Ptr poseObservation(
    const OutputItem& item, const mrpt::poses::CPose3DPDFGaussian& pose, const std::string& label)
{
    auto out = mrpt::obs::CObservationRobotPose::Create();
    out->sensorLabel = label;
    out->timestamp = item.source.observation->timestamp;
    out->pose = pose;
    return out;
}

/** The pose and, for up to `since` frames back, the motions since then. */
[[nodiscard]] std::vector<mrpt::obs::CObservation::Ptr> poseObservations(
    const OutputItem& item, int since)
{
    const RobotMotion& motion = item.frame->motion;
    const std::string& camera = item.source.observation->sensorLabel;
    std::vector<mrpt::obs::CObservation::Ptr> out{
        poseObservation(item, motion.pose, poseLabelOf(camera))};
    for (std::size_t k = 0; k < motion.since.size() && k < static_cast<std::size_t>(since); ++k)
    {
        const std::string label = sinceLabelOf(camera) + std::to_string(k + 1);
        out.push_back(poseObservation(item, motion.since[k], label));
    }
    return out;
}

/** CObservationComment keeps no label of its own, so the text names it. */
[[nodiscard]] mrpt::obs::CObservationComment::Ptr statusComment(const OutputItem& item)
{
    auto out = mrpt::obs::CObservationComment::Create();
    out->timestamp = item.source.observation->timestamp;
    const RobotMotion& motion = item.frame->motion;
    out->text = statusCommentOf(
        item.source.observation->sensorLabel,
        item.source.frameIndex,
        toString(motion.status),
        motion.reason);
    return out;
}
}  // namespace

RawlogSink::RawlogSink(const OdometryOptions& options)
    : writer_(options.output),
      format1_(options.format1),
      onlyPoses_(options.onlyPoses),
      since_(options.since),
      withPoints_(options.withPoints)
{
}

void RawlogSink::add(const OutputItem& item)
{
    numFrames_ += item.frame ? 1 : 0;
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
    if (!onlyPoses_ && item.source.record && !withPoints_)
    {
        writer_.write(*item.source.record);
    }
    else if (!onlyPoses_)
    {
        writer_.write(*observationOf(item));
    }
    if (item.frame)
    {
        for (const auto& observation : poseObservations(item, since_))
        {
            writer_.write(*observation);
        }
        if (!isMeasured(item.frame->motion.status))
        {
            writer_.write(*statusComment(item));
        }
    }
}

void RawlogSink::addFormat1(const OutputItem& item)
{
    if (!item.frame)
    {
        if (!onlyPoses_)
        {
            sensoryFrame_.insert(item.source.observation);
        }
        return;
    }
    if (hasFrame_)
    {
        writeSensoryFrame();
    }
    mrpt::obs::CActionRobotMovement3D movement;
    movement.timestamp = item.source.observation->timestamp;
    movement.estimationMethod = mrpt::obs::CActionRobotMovement3D::emVisualOdometry;
    movement.poseChange = item.frame->motion.increment;
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    writer_.write(actions);

    hasFrame_ = true;
    if (!onlyPoses_)
    {
        sensoryFrame_.insert(observationOf(item));
    }
    for (const auto& observation : poseObservations(item, since_))
    {
        sensoryFrame_.insert(observation);
    }
    if (!isMeasured(item.frame->motion.status))
    {
        sensoryFrame_.insert(statusComment(item));
    }
}

void RawlogSink::writeSensoryFrame()
{
    writer_.write(sensoryFrame_);
    sensoryFrame_.clear();
    hasFrame_ = false;
}

void RawlogSink::close()
{
    if (hasFrame_)
    {
        writeSensoryFrame();
    }
    writer_.close();
}

std::string RawlogSink::description() const
{
    return writer_.path() + ": " + (onlyPoses_ ? "poses" : "observations and poses") + " of " +
           framesText(numFrames_) +
           (since_ > 0 ? ", motions over up to " + framesText(static_cast<std::size_t>(since_))
                       : "") +
           ", format " + (format1_ ? "1" : "2");
}
}  // namespace pointplane
