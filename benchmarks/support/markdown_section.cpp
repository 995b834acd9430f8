// SPDX-License-Identifier: BSD-3-Clause
#include "markdown_section.h"

#include <pointplane/mrpt_io/errors.h>

#include <fstream>
#include <iterator>
#include <utility>

namespace pointplane
{
namespace
{
/** A page, and where its section is. */
struct Section
{
    std::string page;
    std::size_t first, size;
};

Section sectionOf(const std::string& path, const std::string& name)
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
    return {std::move(page), first + begin.size(), last - first - begin.size()};
}
}  // namespace

void checkMarkdownSection(const std::string& path, const std::string& name)
{
    (void)sectionOf(path, name);
}

void replaceMarkdownSection(
    const std::string& path, const std::string& name, const std::string& text)
{
    Section section = sectionOf(path, name);
    section.page.replace(section.first, section.size, text);
    std::ofstream out(path);
    out << section.page;
    out.close();
    if (!out)
    {
        throw EnvironmentError(path + ": cannot be written");
    }
}
}  // namespace pointplane
