// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/PlaneMoments.h>
#include <pointplane/sensor/DepthNoise.h>
#include <pointplane/sensor/PinholeCamera.h>

#include <opencv2/core/mat.hpp>

#include <vector>

namespace pointplane
{
/** A depth image cut into square cells, each with its moments. Pixels beyond the last full cell are
 * left out. The depth image is that of an ideal (undistorted) pinhole camera. */
struct CellGrid
{
    int cellSizePx{10};
    int cols{0}, rows{0};               //!< cells
    std::vector<PlaneMoments> moments;  //!< rows x cols, row-major

    /** Computes all cells of a depth image; the memory is used again.
     * \param depth CV_32FC1 [m], NaN = no reading \param cellSize side of a cell [px], at least 2
     * \throws std::invalid_argument on another image type or cell size */
    void compute(const cv::Mat& depth, const PinholeCamera& camera, int cellSize);

    /** Weighs each cell such that the inverse depth of a pixel has the variance
     * noise.sigmaInverseDepth^2 at every depth (DepthNoise::weight()). */
    void weigh(const DepthNoise& noise);
};
}  // namespace pointplane
