// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseAnalysis.h>

#include "Solution.h"

namespace pointplane
{
// How far the parts of a solution contradict each other. Derivations: docs/theory.md.

/** Whether the references draw the pose apart by more than their covariances allow.
 * \param references by points or by planes, of the solution \param cov of the solution */
[[nodiscard]] Disagreement disagreementOf(
    const Solution& at, const Solution::References& references, const Matrix12d& cov);

/** PoseAnalysis::turnVariance. */
[[nodiscard]] double turnVarianceOf(const Solution& at);

/** PoseAnalysis::scatter. \param of sensitivityOf() the solution */
[[nodiscard]] double scatterOf(const Solution& at, const Sensitivity& of);
}  // namespace pointplane
