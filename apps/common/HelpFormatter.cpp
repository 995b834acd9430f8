// SPDX-License-Identifier: BSD-3-Clause
#include "HelpFormatter.h"

#include <algorithm>
#include <sstream>

namespace pointplane
{
std::string wrappedHelp(const std::string& text, std::size_t columns, std::size_t indent)
{
    constexpr std::size_t kLeastWords = 24;  // else there is a word a line
    if (columns < indent + kLeastWords)
    {
        return text;
    }
    std::istringstream lines(text);
    std::string out, line;
    while (std::getline(lines, line))
    {
        const std::size_t below = std::max(indent, line.find_first_not_of(' '));
        while (line.size() > columns)
        {
            const std::size_t space = line.rfind(' ', columns);
            if (space == std::string::npos || space <= below)
            {
                break;  // a word longer than a line
            }
            out += line.substr(0, space) + "\n";
            line = std::string(below, ' ') + line.substr(space + 1);
        }
        out += line + "\n";
    }
    return out;
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool isPositional) const
{
    return wrappedHelp(
        CLI::Formatter::make_option(option, isPositional), columns_, get_column_width());
}

std::string HelpFormatter::make_description(const CLI::App* app) const
{
    return wrappedHelp(CLI::Formatter::make_description(app), columns_, 0);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const
{
    return wrappedHelp(CLI::Formatter::make_subcommand(command), columns_, get_column_width());
}

std::string HelpFormatter::make_option_name(const CLI::Option* option, bool isPositional) const
{
    const std::string name = CLI::Formatter::make_option_name(option, isPositional);
    return name.substr(0, name.find('{'));
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const
{
    std::string text = CLI::Formatter::make_option_opts(option);
    const std::string again = ":INT in [", dots = " ...";
    if (const auto at = text.find(again); at != std::string::npos)
    {
        text.replace(at, again.size(), " in [");
    }
    const auto at = text.find(dots);
    if (at != std::string::npos && !option->get_positional() && !option->get_allow_extra_args())
    {
        text.erase(at, dots.size());
    }
    return text;
}
}  // namespace pointplane
