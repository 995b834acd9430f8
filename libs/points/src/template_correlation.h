// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstdint>

namespace pointplane
{
/** Sum of a template's gradients times what an image differs from it [grey^2], in the order of
 * cv::calcOpticalFlowPyrLK: positions that follow from it are the same to the bit.
 * \param patch by sampleTemplate \param image with a border \param corner where the template's
 * first pixel is in the image */
[[nodiscard]] cv::Point2f templateCorrelation(
    const std::int16_t* patch, int windowPx, const cv::Mat& image, const cv::Point2f& corner);
}  // namespace pointplane
