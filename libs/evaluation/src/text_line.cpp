// SPDX-License-Identifier: BSD-3-Clause
#include "text_line.h"

#include <pointplane/core/number_text.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace pointplane
{
namespace
{
constexpr std::size_t kFewestColumns = 7;  //!< of a pose

std::vector<double> parseNumbers(
    const std::string& text, const std::string& path, std::size_t line, const std::string& hint)
{
    std::vector<double> numbers;
    const char* const end = text.data() + text.size();
    const char* at = text.data();
    const auto isSeparator = [](char c) { return c == ' ' || c == ',' || c == '\t' || c == '\r'; };
    while (true)
    {
        at = std::find_if_not(at, end, isSeparator);
        if (at == end)
        {
            return numbers;
        }
        const char* const stop = std::find_if(at, end, isSeparator);
        const std::string word(at, stop);
        const auto number = parseNumber<double>(word);
        if (!number)
        {
            failAt(path, line, "'" + word + "' is not a number" + hint);
        }
        numbers.push_back(*number);
        at = stop;
    }
}

/** Whether it is free of control characters and of letters beyond English, which numbers never
 * have. Else it may be anything, and is not for messages. */
bool isAscii(const std::string& line)
{
    const auto isPlain = [](char c) { return (c >= ' ' && c <= '~') || c == '\t' || c == '\r'; };
    return std::all_of(line.begin(), line.end(), isPlain);
}

/** \return a number like 1,5 in a line of columns separated by blanks, or nothing: commas alone
 * separate columns, too */
std::string decimalComma(const std::string& text)
{
    std::istringstream words(text);
    std::string out;
    std::size_t count = 0;
    for (std::string word; words >> word; ++count)
    {
        const std::size_t comma = word.find(',');
        if (out.empty() && comma > 0 && comma != std::string::npos && comma + 1 < word.size())
        {
            out = word;
        }
    }
    return count >= kFewestColumns ? out : "";
}

/** Of the formats of TORO and g2o: VERTEX3, EDGE_SE3:QUAT, EQUIV. */
bool isOfPoseGraph(const std::string& text)
{
    const auto beginsWith = [&](const char* word) { return text.rfind(word, 0) == 0; };
    return beginsWith("VERTEX") || beginsWith("EDGE") || beginsWith("EQUIV");
}
}  // namespace

void failAt(const std::string& path, std::size_t line, const std::string& what)
{
    throw std::runtime_error(path + ":" + std::to_string(line) + ": " + what);
}

std::vector<double> numbersOfLine(
    const std::string& text, const std::string& path, std::size_t line, const std::string& hint)
{
    if (!isAscii(text))
    {
        failAt(path, line, "is not text of numbers, as a trajectory is");
    }
    if (isOfPoseGraph(text))
    {
        failAt(
            path,
            line,
            "is of a pose graph, whose nodes have no time stamps; give the trajectory or the "
            "rawlog that was written with it");
    }
    if (text.find(',') != std::string::npos && !decimalComma(text).empty())
    {
        failAt(path, line, "'" + decimalComma(text) + "' has a decimal comma; write points");
    }
    return parseNumbers(text, path, line, hint);
}
}  // namespace pointplane
