// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace pointplane
{
/** The value that `share` of the values are below. \param values at least one */
template <class T>
[[nodiscard]] T quantile(std::vector<T> values, double share)
{
    const auto below = static_cast<std::size_t>(share * static_cast<double>(values.size()));
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(std::min(below, values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

template <class T>
[[nodiscard]] T median(std::vector<T> values)
{
    return quantile(std::move(values), 0.5);
}
}  // namespace pointplane
