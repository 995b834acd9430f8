// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/CellView.h>
#include <pointplane/sensor/DepthNoise.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <opencv2/core/mat.hpp>

#include <cstdint>

namespace pointplane
{
/** Finds the parts of the view that move with the camera, like a bumper or a gripper of the robot
 * that carries it. It needs no estimate of the camera's motion.
 *
 * A camera that moves past things sees the near ones move most, and one that turns sees all move
 * alike. So what is nearer than most of what changes in the view, and stays the same, moves with
 * the camera. A grid of cells is compared with an earlier view. When most of the surface in view,
 * and most of the view, has changed, each cell is told by whether it has, and the later view
 * becomes the earlier one. */
class AttachedParts
{
 public:
    /** \param frame without colour, or without depth, it tells nothing */
    void update(const RgbdFrame& frame, const DepthNoise& noise);

    /** Not 0 (CV_8UC1, of the frames' size) where the view moves with the camera; empty if it does
     * nowhere. */
    [[nodiscard]] const cv::Mat& mask() const { return mask_; }

    /** Its fraction of the view, 0 to 1. */
    [[nodiscard]] double share() const;

 private:
    CellView earlier_;
    cv::Mat_<std::uint8_t> timesSame_;  //!< of each cell, in a row
    cv::Mat mask_;
};
}  // namespace pointplane
