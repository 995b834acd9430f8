// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/CellGrid.h>
#include <pointplane/planes/PlanarityTest.h>

#include <vector>

namespace pointplane
{
/** A cluster of cells that form one plane. */
struct CellCluster
{
    PlaneMoments moments;
    MomentsFit fit;
    std::vector<int> cells;  //!< indices into the grid
};

/** Agglomerative hierarchical clustering on the graph of cells (Feng, Taguchi & Kamat 2014): the
 * cluster with the least mean squared error is merged with the neighbour that keeps the error
 * least, until no merge passes the test. Two things differ from the publication: errors are in
 * inverse depth, and uniform quads of cells are merged first. The latter keeps the queue short and
 * changes nothing on flat walls.
 *
 * \param minValidFraction of a cell's pixels that must have depth
 * \return clusters of at least minPixels, largest first; ties by cell index. */
[[nodiscard]] std::vector<CellCluster> clusterCells(
    const CellGrid& grid, const PlanarityTest& test, double minValidFraction, double minPixels);

/** Merges clusters that lie on one plane but are not adjacent (a wall behind a column). */
void mergeCoplanar(std::vector<CellCluster>& clusters, const PlanarityTest& test);
}  // namespace pointplane
