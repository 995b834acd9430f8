// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/median_variance.h>

#include <algorithm>
#include <cstddef>

namespace pointplane
{
namespace
{
constexpr double kMedianChi2Of3 = 2.366;
}  // namespace

double medianVariance(std::vector<double>& squaredNorms)
{
    if (squaredNorms.empty())
    {
        return 0;
    }
    const auto middle = squaredNorms.begin() + static_cast<std::ptrdiff_t>(squaredNorms.size() / 2);
    std::nth_element(squaredNorms.begin(), middle, squaredNorms.end());
    return *middle / kMedianChi2Of3;
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
            return norm / kMedianChi2Of3;
        }
    }
    return 0;
}
}  // namespace pointplane
