// SPDX-License-Identifier: BSD-3-Clause
#include "RobotMask.h"

#include <pointplane/mrpt_io/image_file.h>
#include <pointplane/odometry/robot_mask.h>

#include <opencv2/core.hpp>

namespace pointplane
{
RobotMask::RobotMask(const std::string& path)
    : path_(path), image_(path.empty() ? cv::Mat() : readMask(path)), isChecked_(path.empty())
{
}

void RobotMask::requireFit(const SourceItem& item)
{
    const cv::Mat& depth = item.converted->frame.depth;
    if (!isChecked_ && !depth.empty())
    {
        requireMaskSize(path_, image_.size(), depth.size(), item.observation->sensorLabel);
        isChecked_ = true;
    }
}

std::string RobotMask::effectOn(RgbdFrame frame) const
{
    if (image_.size() != frame.depth.size() || image_.empty() || !hasDepth(frame))
    {
        return "";
    }
    frame.depth = frame.depth.clone();
    frame.depth.setTo(0, maskOfDepth(image_, frame.camera) == 0);
    return hasDepth(frame) ? ""
                           : " (" + path_ + " leaves depth at " +
                                 std::to_string(cv::countNonZero(frame.depth > 0)) + " of " +
                                 std::to_string(frame.depth.total()) + " pixels)";
}
}  // namespace pointplane
