// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/CellGrid.h>

#include <vector>

namespace pointplane
{
/** When do pixels belong to one plane? In inverse depth, where the noise is constant; the lateral
 * noise adds with the slope: tolerance^2 = sigma_q^2 + (slopePx |theta_xy| / f)^2. Where a camera's
 * noise is not constant, pixels are weighted (CellGrid::weigh()) such that it becomes so. */
struct PlanarityTest
{
    DepthNoise noise;
    double slopePx{1};     //!< lateral uncertainty of a depth reading [px]
    double bentPixels{1};  //!< what bends surfaces bends this many pixels like one piece
    double focalLengthPx{525};
    double cellSigmas{2.5};  //!< rms residual of one cell, in tolerances
    double mergeSigmas{2};   //!< rms residual of merged cells, in tolerances
    double stepSigmas{2};    //!< rms offset of the smaller part from the joint plane, in tolerances

    /** What lateral noise adds to the variance of a pixel's inverse depth [1/m^2]. */
    [[nodiscard]] double slopeSquared(const Eigen::Vector3d& theta_m) const;

    /** Sum over weighted pixels of the squared residuals that one sigma of noise makes [1/m^2].
     * \param bend how much of what bends surfaces is in them, in [0, 1] of the variance */
    [[nodiscard]] double tolerated(
        const Eigen::Vector3d& theta_m, const PlaneMoments& m, double bend) const;

    /** Of what bends surfaces, the part of the variance that a plane fitted to so many pixels
     * leaves: a smooth error looks plane where little of it is seen. */
    [[nodiscard]] double bendWithin(double numPixels) const;

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
