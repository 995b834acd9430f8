// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace pointplane
{
/** Standard deviation of an image's white noise [grey], at least that of rounding: median response
 * of the difference of two Laplacians, blind to slopes and edges [Immerkaer 1996; the median
 * instead of the mean leaves texture out]. \param gray CV_8UC1 */
[[nodiscard]] double imageNoise(const cv::Mat& gray);

/** How far image noise moves a patch that is searched for, in its worst direction: the Cramer-Rao
 * bound sigma sqrt(2 / lambda) with the smallest eigenvalue lambda of the patch's gradient matrix,
 * less what noise itself contributes to it. Infinite for a patch of noise.
 * \param derivatives CV_16SC2, Scharr's (OpenCV's pyramids), gain 32
 * \param windowPx side of the patch \param noise [grey] \return [px] */
[[nodiscard]] double cornerSigma(
    const cv::Mat& derivatives, const cv::Point2f& centre, int windowPx, double noise);
}  // namespace pointplane
