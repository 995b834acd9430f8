// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cmath>
#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

// Numbers as text and back, the same in every locale.
namespace pointplane
{
/** The number that the whole text is: no blanks, units or decimal commas, but a sign, nan and inf.
 * \tparam T double or an integer
 * \return nothing for any other text, and for a number that T cannot hold */
template <class T>
[[nodiscard]] std::optional<T> parseNumber(std::string_view text)
{
    if (text.size() > 1 && text[0] == '+' && text[1] != '-')  // from_chars knows minus alone
    {
        text.remove_prefix(1);
    }
    T value{};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end)
    {
        return {};
    }
    return value;
}

/** parseNumber<double>() without nan and inf. */
[[nodiscard]] inline std::optional<double> parseFinite(std::string_view text)
{
    const std::optional<double> number = parseNumber<double>(text);
    return number && std::isfinite(*number) ? number : std::nullopt;
}

/** The shortest text that reads back as the same number. */
[[nodiscard]] inline std::string numberText(double value)
{
    char text[64];  // holds every double
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/** A number with so many decimals, right-aligned in `width` characters; in scientific form where
 * its digits would fill the line.
 * \param decimals 0 to 40 */
[[nodiscard]] inline std::string numberText(double value, int decimals, int width = 0)
{
    constexpr double kLongest = 1e12;
    const auto format =
        std::abs(value) < kLongest ? std::chars_format::fixed : std::chars_format::scientific;
    char text[64];
    std::string out(text, std::to_chars(text, text + sizeof text, value, format, decimals).ptr);
    const auto columns = static_cast<std::size_t>(width);
    return out.size() < columns ? out.insert(0, columns - out.size(), ' ') : out;
}

/** A stream to write numbers to, where the program's locale would write others. */
[[nodiscard]] inline std::ostringstream numberStream()
{
    std::ostringstream out;
    out.imbue(std::locale::classic());
    return out;
}
}  // namespace pointplane
