// SPDX-License-Identifier: BSD-3-Clause
#include "point_support.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>
#include <vector>

#include "sorted_by_feature.h"

namespace pointplane
{
namespace
{
/** Points that know a direction, each by what it knows: (sum h)^2 / sum h^2 (Kish 1965). */
double effectivePoints(
    const NormalEquations& equations,
    const std::vector<PointPair>& points,
    const Vector12d& direction)
{
    const auto order = sortedByFeature(points);
    double sum = 0, sumOfSquares = 0;
    for (auto it = order.begin(); it != order.end();)
    {
        const int feature = it->first;
        double h = 0;
        for (; it != order.end() && it->first == feature; ++it)
        {
            h += direction.dot(
                equations.influence(it->second) * equations.jacobian(it->second) * direction);
        }
        sum += h;
        sumOfSquares += h * h;
    }
    return sumOfSquares > 0 ? sum * sum / sumOfSquares : 0;
}
}  // namespace

double supportByPoints(
    const NormalEquations& equations, const PoseProblem& problem, const Matrix12d& H)
{
    const Matrix6d byPoints = equations.points().H.topLeftCorner<6, 6>();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> shares(
        byPoints, Matrix6d(H.topLeftCorner<6, 6>()));
    double out = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 6; ++k)
    {
        if (shares.eigenvalues()[k] > 0.5)
        {
            Vector12d direction = Vector12d::Zero();
            direction.head<6>() = shares.eigenvectors().col(k);
            out = std::min(out, effectivePoints(equations, problem.points, direction));
        }
    }
    return out;
}
}  // namespace pointplane
