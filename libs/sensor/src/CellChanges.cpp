// SPDX-License-Identifier: BSD-3-Clause
#include "CellChanges.h"

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** Correlation of a pattern with itself later. */
constexpr double kSamePattern = 0.9;

/** By depth alone. */
CellChange compareDepth(
    const CellView& earlier, const CellView& later, const cv::Point& cell, const DepthNoise& noise)
{
    CellChange out;
    int numCompared = 0, numOther = 0;
    for (int v = cell.y * CellView::kDepthSide; v < (cell.y + 1) * CellView::kDepthSide; ++v)
    {
        for (int u = cell.x * CellView::kDepthSide; u < (cell.x + 1) * CellView::kDepthSide; ++u)
        {
            const float before = earlier.depth(v, u), now = later.depth(v, u);
            if (before > 0 && now > 0)
            {
                out.nearest = std::min(out.nearest, now);
                out.farthest = std::max(out.farthest, now);
                const auto most = static_cast<float>(noise.sameDepth(static_cast<double>(now)));
                numOther += std::abs(before - now) > most ? 1 : 0;
                ++numCompared;
            }
        }
    }
    if (numCompared > 0)
    {
        out.change = 2 * numOther > numCompared ? Change::Changed : Change::Same;
    }
    return out;
}

CellChange compareCell(
    const CellView& earlier, const CellView& later, const cv::Point& cell, const DepthNoise& noise)
{
    CellChange out = compareDepth(earlier, later, cell, noise);
    const CellView::Contrast contrast = earlier.contrastAt(cell);
    if (out.change == Change::Same && contrast != CellView::Contrast::Noise &&
        later.contrastAt(cell) != CellView::Contrast::Noise)
    {
        const double c = earlier.correlation(later, cell);
        const bool isSame = c > kSamePattern && contrast == CellView::Contrast::ShowsShift;
        out.change = c < kOtherPattern ? Change::Changed
                     : isSame          ? Change::SamePattern
                                       : Change::Same;
    }
    return out;
}
}  // namespace

CellChanges::CellChanges(const CellView& earlier, const CellView& later, const DepthNoise& noise)
    : grid_(later.contrast.size())
{
    for (cv::Point cell; cell.y < grid_.height; ++cell.y)
    {
        for (cell.x = 0; cell.x < grid_.width; ++cell.x)
        {
            cells_.push_back(compareCell(earlier, later, cell, noise));
        }
    }
}
}  // namespace pointplane
