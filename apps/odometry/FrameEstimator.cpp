// SPDX-License-Identifier: BSD-3-Clause
#include "FrameEstimator.h"

#include <algorithm>
#include <utility>

namespace pointplane
{
FrameEstimator::FrameEstimator(const OdometryParams& params, bool keepFeatures)
    : odometry_(params), keepFeatures_(keepFeatures)
{
}

std::string FrameEstimator::problemOf(const ConvertedFrame& converted)
{
    const double stamp = converted.frame.stamp;
    const bool late = numFrames_++ > 0 && stamp <= latestStamp_;
    latestStamp_ = std::max(latestStamp_, stamp);
    if (!converted.problem.empty())
    {
        return converted.problem;
    }
    return late ? "its time stamp is not after that of the frame before" : "";
}

OutputItem FrameEstimator::process(
    SourceItem source, const std::function<void(const std::string&)>& problem)
{
    OutputItem item;
    if (source.converted)
    {
        const ConvertedFrame& converted = *source.converted;
        FrameRecord& record = item.frame.emplace();
        record.result = odometry_.process(converted.frame);
        record.motion = converted.problem.empty()
                            ? trajectory_.add(record.result, converted.T_robot_cam)
                            : trajectory_.add(record.result);
        if (const std::string text = problemOf(converted); !text.empty())
        {
            record.motion.reason = text;
            problem(
                "frame " + std::to_string(source.frameIndex) + " of " +
                source.observation->sensorLabel + ": " + text);
        }
        if (keepFeatures_)
        {
            record.features = odometry_.features();
        }
    }
    item.source = std::move(source);
    return item;
}
}  // namespace pointplane
