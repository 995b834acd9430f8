// SPDX-License-Identifier: BSD-3-Clause
#include "correlated_pixels.h"

#include <Eigen/LU>

#include <algorithm>
#include <limits>
#include <vector>

namespace pointplane
{
namespace
{
/** Blocks along each side of the plane. Fewer see longer waves, more tell the mean better: twice as
 * many or three give the same poses within a few percent. */
constexpr int kBlocksPerSide = 4;

/** Dimensions of a plane: so many blocks fit any plane. What the others tell is averaged with so
 * many more, whose cells each err as one. */
constexpr int kDof = 3;

/** The cells of the plane, summed over a grid of blocks on its bounding box. */
std::vector<PlaneMoments> blocksOf(const CellCluster& plane, const CellGrid& grid)
{
    int left = std::numeric_limits<int>::max(), top = left, right = 0, bottom = 0;
    for (const int cell : plane.cells)
    {
        left = std::min(left, cell % grid.cols);
        right = std::max(right, cell % grid.cols);
        top = std::min(top, cell / grid.cols);
        bottom = std::max(bottom, cell / grid.cols);
    }
    std::vector<PlaneMoments> out(static_cast<size_t>(kBlocksPerSide * kBlocksPerSide));
    for (const int cell : plane.cells)
    {
        const int column = kBlocksPerSide * (cell % grid.cols - left) / (right - left + 1);
        const int row = kBlocksPerSide * (cell / grid.cols - top) / (bottom - top + 1);
        out[static_cast<size_t>(kBlocksPerSide * row + column)] +=
            grid.moments[static_cast<size_t>(cell)];
    }
    out.erase(
        std::remove_if(
            out.begin(), out.end(), [](const PlaneMoments& m) { return !(m.numPixels > 0); }),
        out.end());
    return out;
}
}  // namespace

double correlatedPixels(
    const CellCluster& plane,
    const CellGrid& grid,
    const Eigen::Vector3d& theta_m,
    const Eigen::Matrix3d& cov_m)
{
    const Eigen::Matrix3d A = plane.moments.rayMatrix(), A_inverse = A.inverse();
    const double variance = (cov_m * A).trace() / 3;  // of a pixel
    const std::vector<PlaneMoments> blocks = blocksOf(plane, grid);
    double observed = 0, expected = 0;
    for (const PlaneMoments& block : blocks)
    {
        // The block's score s = sum r (theta . r + q) has the covariance variance (B - B A^-1 B).
        const Eigen::Matrix3d share = A_inverse * block.rayMatrix();
        const Eigen::Vector3d score =
            block.rayMatrix() * theta_m + Eigen::Vector3d(block.xq, block.yq, block.q);
        observed += score.dot(A_inverse * score);
        expected += variance * (share.trace() - (share * share).trace());
    }
    const double dof = std::max(0.0, static_cast<double>(blocks.size()) - kDof);
    const double ofCells = grid.cellSizePx * grid.cellSizePx;
    const double measured = dof > 0 && expected > 0 ? observed / expected : ofCells;
    return std::max(1.0, (dof * measured + kDof * ofCells) / (dof + kDof));
}
}  // namespace pointplane
