// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/PlaneClustering.h>
#include <pointplane/sensor/PinholeCamera.h>

#include <opencv2/core/mat.hpp>

#include <vector>

namespace pointplane
{
/** Paints whole cells with their cluster's label, then, pixel by pixel, the cells at the clusters'
 * borders, which straddle two surfaces: each pixel goes to the largest adjacent plane it fits.
 *
 * \param depth CV_32FC1 [m] \return CV_8UC1, its size: i + 1 = cluster i, 0 = none */
[[nodiscard]] cv::Mat paintLabels(
    const std::vector<CellCluster>& clusters,
    const CellGrid& grid,
    const cv::Mat& depth,
    const PinholeCamera& camera,
    const PlanarityTest& test);
}  // namespace pointplane
