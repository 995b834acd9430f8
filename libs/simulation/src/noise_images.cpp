// SPDX-License-Identifier: BSD-3-Clause
#include "noise_images.h"

#include <pointplane/simulation/Random.h>

#include <opencv2/imgproc.hpp>

#include <cmath>

namespace pointplane
{
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
    const int rows = static_cast<int>(std::ceil(size.height / grid)) + 1;
    const int cols = static_cast<int>(std::ceil(size.width / grid)) + 1;
    // Linear interpolation leaves 4/9 of the variance on average in two dimensions, cubic 0.73.
    const bool isCubic = interpolation == Interpolation::Cubic;
    const double factor = isCubic ? 1.17 : 1.5;
    const cv::Mat coarse = whiteNoise({cols, rows}, factor * sigma, key);
    cv::Mat fine;
    cv::resize(coarse, fine, {}, grid, grid, isCubic ? cv::INTER_CUBIC : cv::INTER_LINEAR);
    return fine(cv::Rect(cv::Point(0, 0), size));
}
}  // namespace pointplane
