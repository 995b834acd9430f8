// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseAnalysis.h>

#include "Solution.h"

namespace pointplane
{
/** PoseAnalysis::patchResiduals. \param of sensitivityOf() the solution */
[[nodiscard]] std::vector<ReferenceVariance> residualsOfPatches(
    const Solution& at, const Sensitivity& of);
}  // namespace pointplane
