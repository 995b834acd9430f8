// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/PlaneMoments.h>
#include <pointplane/sensor/DepthNoise.h>
#include <pointplane/sensor/PinholeCamera.h>

#include <opencv2/core/mat.hpp>

#include <vector>

namespace pointplane
{
/** The depth image cut into square cells, each with its moments. Pixels beyond the last full cell
 * are left out. Depth pixels are those of an ideal (undistorted) pinhole camera. */
struct CellGrid
{
    int cellSizePx{10};
    int cols{0}, rows{0};               //!< cells
    std::vector<PlaneMoments> moments;  //!< rows x cols, row-major

    /** Recomputes from a depth image, reusing the memory.
     * \param depth CV_32FC1 [m], NaN = no reading */
    void compute(const cv::Mat& depth, const PinholeCamera& camera, int cellSize);

    /** Weighs each cell by its noise, so that every weighted pixel's inverse depth has the variance
     * noise.sigmaInverseDepth^2; nothing to do where that is so at every depth. */
    void weigh(const DepthNoise& noise);
};
}  // namespace pointplane
