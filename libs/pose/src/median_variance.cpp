// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/median_variance.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace pointplane
{
double medianChi2(int dof)
{
    constexpr std::array<double, 3> kMedians{0.4549, 1.3863, 2.3660};
    return kMedians.at(static_cast<size_t>(dof) - 1);
}

double medianVariance(std::vector<double>& relativeNorms)
{
    if (relativeNorms.empty())
    {
        return 0;
    }
    const auto middle =
        relativeNorms.begin() + static_cast<std::ptrdiff_t>(relativeNorms.size() / 2);
    std::nth_element(relativeNorms.begin(), middle, relativeNorms.end());
    const bool isOdd = relativeNorms.size() % 2 == 1;
    return isOdd ? *middle : 0.5 * (*middle + *std::max_element(relativeNorms.begin(), middle));
}

double medianVariance(std::vector<std::pair<double, double>>& normsAndWeights)
{
    std::sort(normsAndWeights.begin(), normsAndWeights.end());
    double left = 0;
    for (const auto& [norm, weight] : normsAndWeights)
    {
        left += weight / 2;
    }
    for (std::size_t i = 0; i < normsAndWeights.size(); ++i)
    {
        const auto& [norm, weight] = normsAndWeights[i];
        left -= weight;
        if (left < 0 || i + 1 == normsAndWeights.size())
        {
            return norm;
        }
        if (left == 0)
        {
            return 0.5 * (norm + normsAndWeights[i + 1].first);
        }
    }
    return 0;
}
}  // namespace pointplane
