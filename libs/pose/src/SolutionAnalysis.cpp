// SPDX-License-Identifier: BSD-3-Clause
#include "SolutionAnalysis.h"

#include <pointplane/core/covariance.h>
#include <pointplane/pose/view_cell.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <map>
#include <utility>

#include "sorted_by_feature.h"

namespace pointplane
{
namespace
{
/** A reference says nothing about a direction of which it knows less than this part of what all
 * references and the prior know. */
constexpr double kLeastShare = 0.03;

/** Side of a cell of the view, over its distance: 11 degrees. Half to three times as much tells bad
 * frames as well. */
constexpr double kCell = 0.2;
}  // namespace

/** With scores s_j of covariance M_j, the solution leaves each reference j the gradient
 * g_j = s_j - H_j H^-1 sum(s), whose covariance is
 * M_j - H_j H^-1 M_j - M_j H^-1 H_j + H_j Sigma H_j (docs/theory.md, Noise of features). */
Disagreement disagreementOf(
    const Solution& at, const Solution::References& references, const Matrix12d& cov)
{
    Disagreement out;
    for (const auto& [reference, sum] : references)
    {
        const Matrix12d shared = sum.H * at.H_inverse * sum.M;
        const Matrix12d covOfGradient = sum.M - shared - shared.transpose() + sum.H * cov * sum.H;
        const Eigen::LDLT<Matrix6d> known((sum.H + kLeastShare * at.H).topLeftCorner<6, 6>());
        const Vector6d gradient = sum.g.head<6>();
        out.observed += gradient.dot(known.solve(gradient));
        out.expected += known.solve(Matrix6d(covOfGradient.topLeftCorner<6, 6>())).trace();
    }
    return out;
}

double turnVarianceOf(const Solution& at)
{
    double information = 0;  // of three axes, by all references
    for (const auto& [reference, sum] : at.points)
    {
        information += at.problem.noise.points * sum.H.block<3, 3>(3, 3).trace();
    }
    return information > 0 ? 3 / information : 0;
}

double scatterOf(const Solution& at, const Sensitivity& of)
{
    std::map<std::pair<int, int>, Vector12d> cells;
    std::map<int, Vector12d> planes;
    const auto add = [&](auto& parts, const auto& part, size_t i)
    {
        parts.emplace(part, Vector12d::Zero()).first->second +=
            at.equations.influence(i) * at.equations.residual(i).r;
    };
    for (size_t i = 0; i < at.problem.points.size(); ++i)
    {
        if (at.equations.isUsable(i))
        {
            add(cells, viewCell(at.problem.points[i].cur.mean, kCell), i);
        }
    }
    for (const auto& [plane, i] : sortedByFeature(at.problem.planes))
    {
        if (const size_t pair = at.problem.points.size() + i; at.equations.isUsable(pair))
        {
            add(planes, plane, pair);
        }
    }
    Matrix12d scores = Matrix12d::Zero();
    const auto addSquares = [&](const auto& parts)
    {
        for (const auto& [part, score] : parts)
        {
            scores += score * score.transpose();
        }
    };
    addSquares(cells);
    addSquares(planes);
    const Matrix6d pulls = propagate(at.H_inverse, scores).topLeftCorner<6, 6>();
    // Few features move the solution in some directions only.
    const Eigen::CompleteOrthogonalDecomposition<Matrix6d> noise(
        Matrix6d((of.points + of.planes).topLeftCorner<6, 6>()));
    // The solution brings as many parts to agree as it has directions, right or wrong.
    const bool tells = cells.size() + planes.size() > 6 && noise.rank() > 0;
    return tells ? noise.solve(pulls).trace() / static_cast<double>(noise.rank()) : 0;
}
}  // namespace pointplane
