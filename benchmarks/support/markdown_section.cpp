// SPDX-License-Identifier: BSD-3-Clause
#include "markdown_section.h"

#include <pointplane/mrpt_io/errors.h>

#include <fstream>
#include <iterator>

namespace pointplane
{
void replaceMarkdownSection(
    const std::string& path, const std::string& name, const std::string& text)
{
    std::ifstream in(path);
    if (!in)
    {
        throw InputError(path + ": cannot be read");
    }
    std::string page{std::istreambuf_iterator<char>(in), {}};
    const std::string begin = "<!-- " + name + ":begin -->\n", end = "<!-- " + name + ":end -->";
    const std::size_t first = page.find(begin);
    const std::size_t last = first == std::string::npos ? first : page.find(end, first);
    if (last == std::string::npos)
    {
        throw InputError(path + ": no section between the markers of '" + name + "'");
    }
    page.replace(first + begin.size(), last - first - begin.size(), text);
    std::ofstream out(path);
    out << page;
    out.close();
    if (!out)
    {
        throw EnvironmentError(path + ": cannot be written");
    }
}
}  // namespace pointplane
