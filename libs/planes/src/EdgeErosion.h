// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/PlaneClustering.h>

#include <vector>

namespace pointplane
{
/** Which cells a cluster's plane is fitted to: those that do not touch another cluster, because a
 * cell across an edge mixes two surfaces and yet looks planar (as the erosion of Feng et al. 2014).
 * All cells where hardly any would be left; none for a strip that is nothing but such cells. */
class EdgeErosion
{
 public:
    EdgeErosion(const std::vector<CellCluster>& clusters, const CellGrid& grid);

    [[nodiscard]] CellCluster eroded(const CellCluster& cluster) const;

 private:
    [[nodiscard]] bool touchesAnother(int cell) const;

    const CellGrid& grid_;
    std::vector<int> clusterOfCell_;  //!< -1 = none
};
}  // namespace pointplane
