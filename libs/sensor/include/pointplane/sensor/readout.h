// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>

namespace pointplane
{
/** Where in the readout of a rolling shutter a pixel is exposed: -1/2 in the first line of the
 * sensor, 1/2 in the last. Lines are along the longer side of a sensor, so they are rows, and
 * columns of upright images: a phone's that was held upright, or those of a camera that stands on
 * its side. */
[[nodiscard]] inline double readoutFraction(const Eigen::Vector2d& uv_px, const cv::Size& image)
{
    return (image.height > image.width ? uv_px.x() / image.width : uv_px.y() / image.height) - 0.5;
}
}  // namespace pointplane
