// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace pointplane
{
/** Feature and index of all pairs, those of the same feature one after the other. */
template <class Pairs>
[[nodiscard]] std::vector<std::pair<int, size_t>> sortedByFeature(const Pairs& pairs)
{
    std::vector<std::pair<int, size_t>> out;
    out.reserve(pairs.size());
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        const int own = -1 - static_cast<int>(i);
        out.emplace_back(pairs[i].feature < 0 ? own : pairs[i].feature, i);
    }
    std::sort(out.begin(), out.end());
    return out;
}
}  // namespace pointplane
