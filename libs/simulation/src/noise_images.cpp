// SPDX-License-Identifier: BSD-3-Clause
#include "noise_images.h"

#include <pointplane/simulation/Random.h>

#include <opencv2/imgproc.hpp>

#include <cmath>

namespace pointplane
{
namespace
{
/** \param sigma of the points of the grid, with which those between them are interpolated */
cv::Mat betweenPoints(
    cv::Size size, double grid, double sigma, const NoiseKey& key, cv::InterpolationFlags flag)
{
    const int rows = static_cast<int>(std::ceil(size.height / grid)) + 1;
    const int cols = static_cast<int>(std::ceil(size.width / grid)) + 1;
    cv::Mat fine;
    cv::resize(whiteNoise({cols, rows}, sigma, key), fine, {}, grid, grid, flag);
    return fine(cv::Rect(cv::Point(0, 0), size));
}

/** What linear interpolation leaves of the variance along one axis, on average. */
double varianceLeft(int pixels)
{
    double sum = 0;
    for (int k = 0; k < pixels; ++k)
    {
        const double x = (k + 0.5) / pixels - 0.5;  // of a pixel's centre in the coarse image
        const double f = x - std::floor(x);
        sum += f * f + (1 - f) * (1 - f);
    }
    return sum / pixels;
}
}  // namespace

cv::Mat whiteNoise(cv::Size size, double sigma, const NoiseKey& key)
{
    cv::Mat out(size, CV_32FC1);
    for (int v = 0; v < size.height; ++v)
    {
        Random random({key.seed, key.purpose, static_cast<std::uint64_t>(v)});
        auto* row = out.ptr<float>(v);
        for (int u = 0; u < size.width; ++u)
        {
            row[u] = static_cast<float>(sigma) * random.gaussian();
        }
    }
    return out;
}

cv::Mat windowNoise(cv::Size size, int window, double sigma, const NoiseKey& key)
{
    const cv::Size padded = size + cv::Size(window - 1, window - 1);
    const cv::Mat white = whiteNoise(padded, sigma * window, key);
    if (window == 1)
    {
        return white;
    }
    cv::Mat out;
    cv::boxFilter(white, out, CV_32F, {window, window}, {0, 0});
    return out(cv::Rect(cv::Point(0, 0), size));
}

cv::Mat gridNoise(
    cv::Size size, double grid, double sigma, const NoiseKey& key, Interpolation interpolation)
{
    // Linear interpolation leaves 4/9 of the variance on average in two dimensions, cubic 0.73.
    const bool isCubic = interpolation == Interpolation::Cubic;
    return isCubic ? betweenPoints(size, grid, 1.17 * sigma, key, cv::INTER_CUBIC)
                   : betweenPoints(size, grid, 1.5 * sigma, key, cv::INTER_LINEAR);
}

cv::Mat upsampledNoise(cv::Size size, int pixels, double sigma, const NoiseKey& key)
{
    // The variance that is left is the product of both axes' shares, which are equal.
    return betweenPoints(size, pixels, sigma / varianceLeft(pixels), key, cv::INTER_LINEAR);
}
}  // namespace pointplane
