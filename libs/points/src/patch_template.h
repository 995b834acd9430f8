// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <cstdint>

#include "StripSampler.h"
#include "brightness.h"

namespace pointplane
{
/** A template is a patch at one level of a reference's pyramid, as a search wants it: row by row in
 * strips, each the grey values (in 1/32), then the gradients of eight columns. */
constexpr int kStripSamples = 3 * kStrip;

/** Products of a template's samples in [grey^2]. */
constexpr float kProductScale = 1.F / (1 << 20);

constexpr int kLongestWindow = 63;  //!< [px]

/** Numbers in a template with a side of so many pixels. */
[[nodiscard]] std::size_t templateSize(int windowPx);

/** Sums of products of a template's gradients. */
struct NormalMatrix
{
    float xx{0}, xy{0}, yy{0};
    float inverseDeterminant{0};  //!< 0 = no structure
};

/** Samples a template. \param image, derivatives a level of cv::buildOpticalFlowPyramid
 * \param corner its first pixel; it may be in the level's border \param out of templateSize */
[[nodiscard]] NormalMatrix sampleTemplate(
    const cv::Mat& image,
    const cv::Mat& derivatives,
    const cv::Point2f& corner,
    int windowPx,
    Brightness brightness,
    std::int16_t* out);
}  // namespace pointplane
