// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseAnalysis.h>

#include "Solution.h"

namespace pointplane
{
/** How a solution changes with its references and features. Prior and camera are not set.
 * Derivation: docs/theory.md, Window. */
[[nodiscard]] Sensitivity sensitivityOf(const Solution& at);
}  // namespace pointplane
