// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/uncertainty/JointCovariance.h>
#include <pointplane/odometry/uncertainty/ResidualVariogram.h>
#include <pointplane/pose/PoseSolver.h>

namespace pointplane
{
/** What an estimate's errors come from: noise of the frame itself and drift of the references, as
 * the residuals of the frames so far tell them. Errors of shutter and prediction are not in it.
 * Derivation in docs/theory.md, Window.
 * \param levels of noise and drift over the propagated variances
 * \param views since the previous measured frame (numViews()) */
[[nodiscard]] JointCovariance::Measurement frameErrors(
    const PoseEstimate& estimate,
    const Sensitivity& of,
    const ResidualVariogram::Levels& levels,
    double views,
    const JointCovariance::TParams& params);
}  // namespace pointplane
