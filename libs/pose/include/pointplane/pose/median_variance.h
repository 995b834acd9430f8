// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace pointplane
{
/** Variance of 3-vectors over their covariances, whatever a few wrong ones are: the median of their
 * squared Mahalanobis norms over that of chi-square with 3 degrees of freedom.
 * \param squaredNorms are put in another order \return 0 of none */
[[nodiscard]] double medianVariance(std::vector<double>& squaredNorms);
}  // namespace pointplane
