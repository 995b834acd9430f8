// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeErosion.h"

#include <algorithm>

namespace pointplane
{
namespace
{
constexpr double kMinFraction = 0.25;
}

EdgeErosion::EdgeErosion(const std::vector<CellCluster>& clusters, const CellGrid& grid)
    : grid_(grid), clusterOfCell_(grid.moments.size(), -1)
{
    for (size_t i = 0; i < clusters.size(); ++i)
    {
        for (const int cell : clusters[i].cells)
        {
            clusterOfCell_[static_cast<size_t>(cell)] = static_cast<int>(i);
        }
    }
}

CellCluster EdgeErosion::eroded(const CellCluster& cluster) const
{
    CellCluster out;
    out.fit = cluster.fit;
    for (const int cell : cluster.cells)
    {
        if (!touchesAnother(cell))
        {
            out.cells.push_back(cell);
            out.moments += grid_.moments[static_cast<size_t>(cell)];
        }
    }
    return out.cells.empty() || out.moments.numPixels > kMinFraction * cluster.moments.numPixels
               ? out
               : cluster;
}

bool EdgeErosion::touchesAnother(int cell) const
{
    const int own = clusterOfCell_[static_cast<size_t>(cell)];
    const int col = cell % grid_.cols, row = cell / grid_.cols;
    for (int r = std::max(0, row - 1); r <= std::min(grid_.rows - 1, row + 1); ++r)
    {
        for (int c = std::max(0, col - 1); c <= std::min(grid_.cols - 1, col + 1); ++c)
        {
            const int other = clusterOfCell_[static_cast<size_t>(r * grid_.cols + c)];
            if (other >= 0 && other != own)
            {
                return true;
            }
        }
    }
    return false;
}
}  // namespace pointplane
