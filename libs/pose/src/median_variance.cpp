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

double medianVariance(std::vector<double>& relativeSquares)
{
    if (relativeSquares.empty())
    {
        return 0;
    }
    const auto middle =
        relativeSquares.begin() + static_cast<std::ptrdiff_t>(relativeSquares.size() / 2);
    std::nth_element(relativeSquares.begin(), middle, relativeSquares.end());
    const bool isOdd = relativeSquares.size() % 2 == 1;
    return isOdd ? *middle : 0.5 * (*middle + *std::max_element(relativeSquares.begin(), middle));
}

double medianVariance(std::vector<std::pair<double, double>>& squaresAndWeights)
{
    std::sort(squaresAndWeights.begin(), squaresAndWeights.end());
    double left = 0;
    for (const auto& [norm, weight] : squaresAndWeights)
    {
        left += weight / 2;
    }
    for (std::size_t i = 0; i < squaresAndWeights.size(); ++i)
    {
        const auto& [norm, weight] = squaresAndWeights[i];
        left -= weight;
        if (left < 0 || i + 1 == squaresAndWeights.size())
        {
            return norm;
        }
        if (left == 0)
        {
            return 0.5 * (norm + squaresAndWeights[i + 1].first);
        }
    }
    return 0;
}
}  // namespace pointplane
