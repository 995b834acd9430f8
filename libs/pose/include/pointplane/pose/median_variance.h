// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace pointplane
{
/** Variance of 3-vectors over their covariances, robust against wrong ones: the median of their
 * squared Mahalanobis norms, over that of chi-square with 3 degrees of freedom.
 * \param squaredNorms of the vectors; their order changes
 * \return 0 if there are none */
[[nodiscard]] double medianVariance(std::vector<double>& squaredNorms);
}  // namespace pointplane
