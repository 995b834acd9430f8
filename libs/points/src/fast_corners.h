// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include <vector>

namespace pointplane
{
/** FAST-9 corners with non-maximum suppression. Cells of the grid without a corner are searched
 * again at a third of the threshold, so that dark or blurred parts of a picture get corners too.
 * Their response is Shi and Tomasi's. \param borderPx at least 5 */
[[nodiscard]] std::vector<cv::KeyPoint> fastCorners(
    const cv::Mat& gray, int threshold, int cellPx, int borderPx);

/** Moves corners to where the gradients around them agree; one that would go farther than 1.5 px
 * stays. */
void refineCorners(const cv::Mat& gray, std::vector<cv::KeyPoint>& corners);
}  // namespace pointplane
