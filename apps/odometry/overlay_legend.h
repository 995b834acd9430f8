// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <optional>

#include "overlay.h"

namespace pointplane
{
/** Below a picture: the frame's status, what became of its points and planes, and what colours
 * mean; in as many lines as the width takes. \return CV_8UC3, BGR, as wide as said */
[[nodiscard]] cv::Mat overlayLegend(
    int width,
    const FrameRecord& record,
    std::size_t frameIndex,
    double seconds,
    const std::optional<CameraSpeed>& speed);
}  // namespace pointplane
