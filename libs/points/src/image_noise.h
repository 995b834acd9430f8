// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace pointplane
{
/** Standard deviation of an image's white noise [grey], at least that of rounding: median response
 * of the difference of two Laplacians, blind to slopes and edges [Immerkaer 1996; the median
 * instead of the mean leaves texture out]. \param gray CV_8UC1 */
[[nodiscard]] double imageNoise(const cv::Mat& gray);
}  // namespace pointplane
