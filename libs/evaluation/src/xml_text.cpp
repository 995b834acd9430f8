// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/svg_chart.h>

#include <cstddef>
#include <cstdint>

namespace pointplane
{
namespace
{
constexpr const char* kReplacement = "\xef\xbf\xbd";  // U+FFFD

/** \return bytes of the character at `at` in UTF-8 (RFC 3629); 0 if there is none, or one that XML
 * does not allow */
std::size_t lengthOfCharacter(const std::string& text, std::size_t at)
{
    const auto byte = [&](std::size_t k)
    { return at + k < text.size() ? static_cast<unsigned char>(text[at + k]) : 0U; };
    const std::uint32_t first = byte(0);
    if (first < 0x80)
    {
        return first >= 0x20 || first == '\n' || first == '\t' || first == '\r' ? 1 : 0;
    }
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 0;
    std::uint32_t code = first & (0xffU >> (length + 1));
    for (std::size_t k = 1; k < length; ++k)
    {
        if ((byte(k) & 0xc0U) != 0x80)
        {
            return 0;
        }
        code = code << 6U | (byte(k) & 0x3fU);
    }
    constexpr std::uint32_t kFirst[5] = {0, 0, 0x80, 0x800, 0x10000};  // of each length
    const bool isSurrogate = code >= 0xd800 && code <= 0xdfff;
    const bool isCharacter = code >= kFirst[length] && code <= 0x10ffff && !isSurrogate &&
                             code != 0xfffe && code != 0xffff;
    return isCharacter ? length : 0;
}
}  // namespace

std::string xmlEscaped(const std::string& text)
{
    std::string out;
    for (std::size_t at = 0; at < text.size();)
    {
        const std::size_t length = lengthOfCharacter(text, at);
        switch (length == 0 ? '\0' : text[at])
        {
            case '\0':
                out += kReplacement;
                break;
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out.append(text, at, length);
        }
        at += length == 0 ? 1 : length;
    }
    return out;
}
}  // namespace pointplane
