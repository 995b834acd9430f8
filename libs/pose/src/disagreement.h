// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "NormalEquations.h"

namespace pointplane
{
/** Whether groups of residuals draw the pose apart by more than their covariances allow.
 *
 * With scores s_g of covariance M_g, the solution leaves each group the gradient
 * g_g = s_g - H_g H^-1 sum(s), whose covariance is
 * M_g - H_g H^-1 M_g - M_g H^-1 H_g + H_g Sigma H_g (docs/theory.md, Noise).
 *
 * \param groups some or all groups \param H of all residuals and the prior
 * \param cov of the solution, Sigma */
[[nodiscard]] Disagreement disagreementOf(
    const std::map<int, FeatureSum>& groups,
    const Matrix12d& H,
    const Matrix12d& H_inverse,
    const Matrix12d& cov);
}  // namespace pointplane
