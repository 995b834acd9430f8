// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseAnalysis.h>

#include "NormalEquations.h"

namespace pointplane
{
/** How large the residuals of planes are.
 * \param equations evaluated at the solution of the problem */
[[nodiscard]] PlaneResiduals residualsOfPlanes(
    const NormalEquations& equations, const PoseProblem& problem);
}  // namespace pointplane
