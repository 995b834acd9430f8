// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace pointplane
{
/** A number with so many decimals, right-aligned in `width` characters; in scientific form where
 * its digits would fill the line. */
[[nodiscard]] inline std::string numberText(double value, int decimals, int width = 0)
{
    constexpr double kLongest = 1e12;
    char text[64];
    std::snprintf(
        text, sizeof text, std::abs(value) < kLongest ? "%*.*f" : "%*.*e", width, decimals, value);
    return text;
}
}  // namespace pointplane
