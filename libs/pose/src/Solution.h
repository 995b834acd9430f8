// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseSolver.h>

#include <map>

#include "NormalEquations.h"

namespace pointplane
{
/** The normal equations at the solution of a problem. */
struct Solution
{
    using References = std::map<int, FeatureSum>;  //!< what each of them adds to the equations

    const NormalEquations& equations;
    const PoseProblem& problem;
    const Matrix12d& H;  //!< of all pairs and the prior
    const Matrix12d& H_inverse;
    References points, planes;
};

/** All arguments must live as long as the result.
 * \param equations evaluated at the solution \param H of all pairs and the prior */
[[nodiscard]] Solution solutionOf(
    const NormalEquations& equations,
    const PoseProblem& problem,
    const Matrix12d& H,
    const Matrix12d& H_inverse);
}  // namespace pointplane
