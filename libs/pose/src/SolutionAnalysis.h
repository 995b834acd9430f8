// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseAnalysis.h>

#include "Solution.h"

namespace pointplane
{
// What a solution tells besides the motion. Derivations: docs/theory.md.

/** How it changes with its references and features. Prior and camera are not set. */
[[nodiscard]] Sensitivity sensitivityOf(const Solution& at);

/** Sets all that is about the camera's errors. */
void addCamera(const Solution& at, PoseAnalysis& out);

/** How large the residuals of planes are. */
[[nodiscard]] PlaneResiduals residualsOfPlanes(const Solution& at);

/** PoseAnalysis::patchResiduals. \param of sensitivityOf() the solution */
[[nodiscard]] std::vector<ReferenceVariance> residualsOfPatches(
    const Solution& at, const Sensitivity& of);

/** Whether the references draw the pose apart by more than their covariances allow.
 * \param references by points or by planes, of the solution \param cov of the solution */
[[nodiscard]] Disagreement disagreementOf(
    const Solution& at, const Solution::References& references, const Matrix12d& cov);

/** PoseAnalysis::turnVariance. */
[[nodiscard]] double turnVarianceOf(const Solution& at);

/** PoseAnalysis::scatter. \param of sensitivityOf() the solution */
[[nodiscard]] double scatterOf(const Solution& at, const Sensitivity& of);
}  // namespace pointplane
