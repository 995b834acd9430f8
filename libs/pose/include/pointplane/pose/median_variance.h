// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

namespace pointplane
{
/** Variance of 3-vectors over their covariances, robust against wrong ones: the median of their
 * squared Mahalanobis norms, over that of chi-square with 3 degrees of freedom.
 * \param squaredNorms of the vectors; their order changes
 * \return 0 if there are none */
[[nodiscard]] double medianVariance(std::vector<double>& squaredNorms);

/** The same where vectors count by a weight: half of the weight is on norms up to the median.
 * \param normsAndWeights squared norm and weight of each vector; their order changes */
[[nodiscard]] double medianVariance(std::vector<std::pair<double, double>>& normsAndWeights);
}  // namespace pointplane
