// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/RobotTrajectory.h>
#include <pointplane/odometry/Odometry.h>

#include <cstddef>
#include <functional>
#include <string>

#include "FrameRecord.h"

namespace pointplane
{
/** Frame after frame through the odometry; complaints about single frames. */
class FrameEstimator
{
 public:
    /** \param keepFeatures put points and planes into the records */
    FrameEstimator(const OdometryParams& params, bool keepFeatures);

    /** \param problem receives a line about a frame that cannot be used */
    [[nodiscard]] OutputItem process(
        SourceItem source, const std::function<void(const std::string&)>& problem);

 private:
    /** \return why the frame cannot be used, or empty */
    [[nodiscard]] std::string problemOf(const ConvertedFrame& converted);

    Odometry odometry_;
    RobotTrajectory trajectory_;
    bool keepFeatures_;
    std::size_t numFrames_{0};
    double latestStamp_{0};
};
}  // namespace pointplane
