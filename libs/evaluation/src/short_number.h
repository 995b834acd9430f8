// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <string>

namespace pointplane
{
/** A number of at most so many significant digits, the same in every locale. */
[[nodiscard]] inline std::string shortNumber(double value, int digits = 6)
{
    char text[64];
    return {
        text,
        std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr};
}
}  // namespace pointplane
