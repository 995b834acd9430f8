// SPDX-License-Identifier: BSD-3-Clause
#include "spread.h"

#include <algorithm>
#include <numeric>

namespace pointplane
{
std::vector<int> selectSpread(
    const std::vector<cv::KeyPoint>& points, cv::Size image, int cellPx, int maxPoints)
{
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    if (static_cast<int>(points.size()) <= maxPoints)
    {
        return order;
    }
    const auto response = [&](int i) { return points[static_cast<size_t>(i)].response; };
    std::sort(
        order.begin(),
        order.end(),
        [&](int a, int b)
        { return response(a) != response(b) ? response(a) > response(b) : a < b; });

    // The rank of each point within its cell is the round in which it is taken.
    const int cols = image.width / cellPx + 1, rows = image.height / cellPx + 1;
    std::vector<int> taken(static_cast<size_t>(cols * rows), 0);
    std::vector<int> round(points.size());
    for (const int i : order)
    {
        const cv::Point2f& p = points[static_cast<size_t>(i)].pt;
        const int col = std::clamp(static_cast<int>(p.x) / cellPx, 0, cols - 1);
        const int row = std::clamp(static_cast<int>(p.y) / cellPx, 0, rows - 1);
        round[static_cast<size_t>(i)] = taken[static_cast<size_t>(row * cols + col)]++;
    }
    std::stable_sort(
        order.begin(),
        order.end(),
        [&](int a, int b)
        { return round[static_cast<size_t>(a)] < round[static_cast<size_t>(b)]; });
    order.resize(static_cast<size_t>(maxPoints));
    std::sort(order.begin(), order.end());
    return order;
}
}  // namespace pointplane
