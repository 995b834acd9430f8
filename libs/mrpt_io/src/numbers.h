// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <optional>
#include <string>

namespace pointplane
{
/** The number that the whole text is, independent of the locale; nothing for "2.5 x", "0,25", "".
 */
template <class T>
[[nodiscard]] std::optional<T> parseNumber(const std::string& text)
{
    T value{};
    const char* begin = text.data();
    const char* end = begin + text.size();
    if (begin != end && *begin == '+')
    {
        ++begin;
    }
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || stop != end)
    {
        return {};
    }
    return value;
}

/** The shortest text that reads back as the same number. */
[[nodiscard]] inline std::string numberText(double value)
{
    char text[64];
    const auto [end, error] = std::to_chars(text, text + sizeof(text), value);
    (void)error;  // 64 characters hold every double
    return {text, end};
}
}  // namespace pointplane
