// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/median_variance.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pointplane
{
double medianChi2(int dof) { return dof == 2 ? 2 * std::log(2.0) : 2.366; }

double medianVariance(std::vector<double>& relativeNorms)
{
    if (relativeNorms.empty())
    {
        return 0;
    }
    const auto middle =
        relativeNorms.begin() + static_cast<std::ptrdiff_t>(relativeNorms.size() / 2);
    std::nth_element(relativeNorms.begin(), middle, relativeNorms.end());
    return *middle;
}

double medianVariance(std::vector<std::pair<double, double>>& normsAndWeights)
{
    std::sort(normsAndWeights.begin(), normsAndWeights.end());
    double left = 0;
    for (const auto& [norm, weight] : normsAndWeights)
    {
        left += weight / 2;
    }
    for (const auto& [norm, weight] : normsAndWeights)
    {
        left -= weight;
        if (left <= 0)
        {
            return norm;
        }
    }
    return 0;
}
}  // namespace pointplane
