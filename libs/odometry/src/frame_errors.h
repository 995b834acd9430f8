// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/JointCovariance.h>
#include <pointplane/pose/PoseSolver.h>

namespace pointplane
{
/** What an estimate's errors come from: noise of the frame itself and drift of the references, on
 * one scale for all cameras by what the residuals and the references' disagreement say. Errors of
 * shutter and prediction are not in it. Derivation in docs/theory.md, Window.
 * \param residuals variance over the propagated one \param disagreement what references add to that
 * \param motion since the previous measured frame, dt [s] before \pre dt > 0 */
[[nodiscard]] JointCovariance::Measurement frameErrors(
    const Sensitivity& sensitivity,
    const NoiseFactors& residuals,
    const NoiseFactors& disagreement,
    const Eigen::Isometry3d& motion,
    double dt,
    const JointCovariance::TParams& params);
}  // namespace pointplane
