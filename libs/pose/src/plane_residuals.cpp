// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/median_variance.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <map>
#include <vector>

#include "SolutionAnalysis.h"

namespace pointplane
{
namespace
{
/** Residuals of planes have three dimensions each, but poses follow some of these. If less than
 * this part of them is left, they tell nothing of the noise. Three planes that alone tell the pose
 * have a third left. */
constexpr double kLeastLeft = 0.25;
}  // namespace

/** Poses follow planes by as many dimensions as planes tell of them: that of the frame does, and
 * those of the references did. Residuals have so many fewer. */
PlaneResiduals residualsOfPlanes(const Solution& at)
{
    PlaneResiduals out;
    const Matrix6d byPlanes = at.equations.planes().H.topLeftCorner<6, 6>();
    const Matrix6d byPoints = at.equations.points().H.topLeftCorner<6, 6>();
    const Matrix6d H = byPlanes + byPoints;
    const double dimensions = H.completeOrthogonalDecomposition().solve(byPlanes).trace();
    if (!byPoints.isZero(0))
    {
        // What nothing tells (H is singular there) must not count as told by points.
        const Matrix6d told = H + 1e-14 * H.trace() * Matrix6d::Identity();
        const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> parts(
            byPoints, told, Eigen::EigenvaluesOnly | Eigen::Ax_lBx);
        out.followed = std::clamp(1 - parts.eigenvalues().maxCoeff(), 0.0, 1.0);
    }
    std::map<int, std::vector<double>> squares;
    for (size_t i = 0; i < at.problem.planes.size(); ++i)
    {
        if (const size_t pair = at.problem.points.size() + i; at.equations.isUsable(pair))
        {
            squares[at.problem.planes[i].reference].push_back(at.equations.relativeSquare(pair));
        }
    }
    for (auto& [reference, ofPlanes] : squares)
    {
        const double all = 3 * static_cast<double>(ofPlanes.size()), dof = all - dimensions;
        if (dof >= kLeastLeft * all)
        {
            out.references.push_back({reference, medianVariance(ofPlanes) * all / dof, dof});
        }
    }
    return out;
}
}  // namespace pointplane
