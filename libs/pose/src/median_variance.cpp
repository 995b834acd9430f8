// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/median_variance.h>

#include <algorithm>
#include <cstddef>

namespace pointplane
{
double medianVariance(std::vector<double>& squaredNorms)
{
    constexpr double kMedianChi2Of3 = 2.366;
    if (squaredNorms.empty())
    {
        return 0;
    }
    const auto middle = squaredNorms.begin() + static_cast<std::ptrdiff_t>(squaredNorms.size() / 2);
    std::nth_element(squaredNorms.begin(), middle, squaredNorms.end());
    return *middle / kMedianChi2Of3;
}
}  // namespace pointplane
