// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "NormalEquations.h"

namespace pointplane
{
/** PoseSolver::pointSupport().
 * \param equations evaluated at the solution of the problem
 * \param H of all pairs and the prior */
[[nodiscard]] double supportByPoints(
    const NormalEquations& equations, const PoseProblem& problem, const Matrix12d& H);
}  // namespace pointplane
