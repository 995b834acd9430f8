// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include <vector>

namespace pointplane
{
/** Indices of at most maxPoints points spread over the image, in increasing order: the strongest of
 * every grid cell first, then the second strongest of every cell, and so on; the last round takes
 * its strongest. Ties go to the lower index, so that the outcome is reproducible. */
[[nodiscard]] std::vector<int> selectSpread(
    const std::vector<cv::KeyPoint>& points, cv::Size image, int cellPx, int maxPoints);
}  // namespace pointplane
