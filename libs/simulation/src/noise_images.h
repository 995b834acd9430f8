// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstdint>

namespace pointplane
{
/** Where random numbers come from: images of another seed or purpose are independent. */
struct NoiseKey
{
    std::uint64_t seed;     //!< of a frame or of a camera
    std::uint64_t purpose;  //!< of one of the images that it needs
};

/** @name Images of Gaussian noise, CV_32FC1, with standard deviation sigma over the image
 * @{ */
[[nodiscard]] cv::Mat whiteNoise(cv::Size size, double sigma, const NoiseKey& key);

/** Neighbours share a box of window x window pixels. */
[[nodiscard]] cv::Mat windowNoise(cv::Size size, int window, double sigma, const NoiseKey& key);

enum class Interpolation
{
    Linear,
    Cubic  //!< without kinks
};

/** Interpolated between the points of a grid. \param grid their spacing [px] */
[[nodiscard]] cv::Mat gridNoise(
    cv::Size size,
    double grid,
    double sigma,
    const NoiseKey& key,
    Interpolation interpolation = Interpolation::Linear);

/** Of a sensor whose pixels are so many pixels wide, interpolated linearly between their centres.
 */
[[nodiscard]] cv::Mat upsampledNoise(cv::Size size, int pixels, double sigma, const NoiseKey& key);
/** @} */
}  // namespace pointplane
