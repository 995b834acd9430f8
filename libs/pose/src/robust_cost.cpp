// SPDX-License-Identifier: BSD-3-Clause
#include "robust_cost.h"

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** [P17, after Eq. 10] */
double tukeyWeight(double squaredNorm, double limit)
{
    const double u = squaredNorm / (limit * limit);
    return u < 1 ? (1 - u) * (1 - u) : 0;
}

double tukeyCost(double squaredNorm, double limit)
{
    const double u = std::min(1.0, squaredNorm / (limit * limit));
    return limit * limit / 3 * (1 - (1 - u) * (1 - u) * (1 - u));
}
}  // namespace

RobustCost tukey(double squaredNorm, double limit)
{
    return {tukeyWeight(squaredNorm, limit), tukeyCost(squaredNorm, limit)};
}

RobustCost student(double squaredNorm, double dof)
{
    return {(dof + 3) / (dof + squaredNorm), (dof + 3) * std::log1p(squaredNorm / dof)};
}
}  // namespace pointplane
