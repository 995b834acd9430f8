// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/CellGrid.h>

#include <vector>

namespace pointplane
{
/** When do pixels belong to one plane? In inverse depth, where the noise is constant; the lateral
 * noise adds with the slope: tolerance^2 = sigma_q^2 + (slopePx |theta_xy| / f)^2. */
struct PlanarityTest
{
    double sigmaInverseDepth{1.425e-3};  //!< [1/m]
    double slopePx{1};                   //!< lateral uncertainty of a depth reading [px]
    double focalLengthPx{525};
    double cellSigmas{2.5};  //!< rms residual of one cell, in tolerances
    double mergeSigmas{2};   //!< rms residual of merged cells, in tolerances
    double stepSigmas{2};    //!< rms offset of the smaller part from the joint plane, in tolerances

    [[nodiscard]] double toleranceSquared(const Eigen::Vector3d& theta_m) const;
    [[nodiscard]] bool isPlanarCell(const PlaneMoments& cell) const;

    /** The joint fit when the two parts are one plane. */
    [[nodiscard]] std::optional<MomentsFit> merged(
        const PlaneMoments& a, double sseA, const PlaneMoments& b, double sseB) const;
};

/** A cluster of cells that form one plane. */
struct CellCluster
{
    PlaneMoments moments;
    MomentsFit fit;
    std::vector<int> cells;  //!< indices into the grid
};

/** Agglomerative hierarchical clustering on the cell graph (Feng, Taguchi & Kamat 2014): the node
 * of least mean squared error is merged with the neighbour that keeps the error least, until no
 * merge passes the test. Differs from the publication: errors are in inverse depth, and uniform
 * quads are merged first, which leaves the result on flat walls unchanged and the queue short.
 * \param minValidFraction of a cell's pixels that must have depth
 * \return clusters of at least minPixels, largest first; ties by cell index. */
[[nodiscard]] std::vector<CellCluster> clusterCells(
    const CellGrid& grid, const PlanarityTest& test, double minValidFraction, double minPixels);

/** Merges clusters that lie on one plane but are not adjacent (a wall behind a column). */
void mergeCoplanar(std::vector<CellCluster>& clusters, const PlanarityTest& test);
}  // namespace pointplane
