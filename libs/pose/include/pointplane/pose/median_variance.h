// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

namespace pointplane
{
/** Median of chi-square with 1 to 3 degrees of freedom. */
[[nodiscard]] double medianChi2(int dof);

/** Variance of vectors over their covariances, robust against wrong ones: the median of their
 * squared Mahalanobis norms, each over medianChi2() of its degrees of freedom. Of an even number,
 * it is the mean of the middle two. \param relativeSquares of the vectors; their order changes
 * \return 0 if there are none */
[[nodiscard]] double medianVariance(std::vector<double>& relativeSquares);

/** The same where vectors count by a weight: half of the weight is on norms up to the median.
 * \param squaresAndWeights relative norm and weight of each vector; their order changes */
[[nodiscard]] double medianVariance(std::vector<std::pair<double, double>>& squaresAndWeights);
}  // namespace pointplane
