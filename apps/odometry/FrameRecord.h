// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/RobotTrajectory.h>

#include <optional>

#include "FrameSource.h"

namespace pointplane
{
/** Whether some directions of its motion are predicted. */
[[nodiscard]] inline bool isInPart(const RobotMotion& motion)
{
    return motion.status == TrackingStatus::Tracked && motion.diagnostics.observableDirections < 6;
}

/** What the odometry made of one frame. */
struct FrameRecord
{
    RobotMotion motion;
    FrameFeatures features;  //!< only if a sink asked for them
};

/** One observation of the input on its way out. */
struct OutputItem
{
    SourceItem source;
    std::optional<FrameRecord> frame;  //!< if the observation is of the camera
};
}  // namespace pointplane
