// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** What an M-estimator makes of a squared norm. The weight is the derivative of the cost. */
struct RobustCost
{
    double weight{0}, cost{0};
};

/** Tukey's: from the limit on, nothing changes. */
[[nodiscard]] RobustCost tukey(double squaredNorm, double limit);

/** Of Student's t in three dimensions. */
[[nodiscard]] RobustCost student(double squaredNorm, double dof);
}  // namespace pointplane
