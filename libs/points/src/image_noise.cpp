// SPDX-License-Identifier: BSD-3-Clause
#include "image_noise.h"

#include <pointplane/core/quantile.h>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

namespace pointplane
{
double imageNoise(const cv::Mat& gray)
{
    constexpr int kStep = 4;                 // every fourth pixel tells enough
    constexpr double kGain = 6;              // root of the mask's sum of squares
    constexpr double kMedianSigma = 0.6745;  // median of |x| for a standard normal x
    constexpr double kLeast = 0.3;           // rounding to whole grey levels
    std::vector<int> responses;
    responses.reserve(gray.total() / (kStep * kStep));
    for (int v = 1; v + 1 < gray.rows; v += kStep)
    {
        const uchar* above = gray.ptr<uchar>(v - 1);
        const uchar* here = gray.ptr<uchar>(v);
        const uchar* below = gray.ptr<uchar>(v + 1);
        for (int u = 1; u + 1 < gray.cols; u += kStep)
        {
            responses.push_back(std::abs(
                above[u - 1] - 2 * above[u] + above[u + 1] - 2 * here[u - 1] + 4 * here[u] -
                2 * here[u + 1] + below[u - 1] - 2 * below[u] + below[u + 1]));
        }
    }
    if (responses.empty())
    {
        return kLeast;
    }
    return std::max(kLeast, median(std::move(responses)) / kMedianSigma / kGain);
}
}  // namespace pointplane
