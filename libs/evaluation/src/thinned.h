// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pointplane
{
/** Indices of some thousand values that look like all of them: of each stretch the first, the
 * lowest, the highest and what is not a number, which is a gap; and the last of all. */
inline std::vector<std::size_t> thinned(const std::vector<double>& y)
{
    constexpr std::size_t kMaxPoints = 3000;
    const std::size_t stride = std::max<std::size_t>(1, 3 * y.size() / kMaxPoints);
    std::vector<std::size_t> keep;
    for (std::size_t begin = 0; begin < y.size(); begin += stride)
    {
        std::size_t low = begin;
        std::size_t high = begin;
        for (std::size_t k = begin; k < std::min(begin + stride, y.size()); ++k)
        {
            low = std::isnan(y[low]) || y[k] < y[low] ? k : low;
            high = std::isnan(y[high]) || y[k] > y[high] ? k : high;
            if (!std::isfinite(y[k]))
            {
                keep.push_back(k);
            }
        }
        keep.insert(keep.end(), {begin, low, high});
    }
    if (!y.empty())
    {
        keep.push_back(y.size() - 1);
    }
    std::sort(keep.begin(), keep.end());
    keep.erase(std::unique(keep.begin(), keep.end()), keep.end());
    return keep;
}
}  // namespace pointplane
