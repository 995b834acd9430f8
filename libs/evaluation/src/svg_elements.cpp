// SPDX-License-Identifier: BSD-3-Clause
#include "svg_elements.h"

#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/svg_chart.h>

namespace pointplane
{
namespace svg
{
std::string number(double value)
{
    const std::string out = numberText(value, 1);
    return out.size() > 2 && out.compare(out.size() - 2, 2, ".0") == 0
               ? out.substr(0, out.size() - 2)
               : out;
}

std::string point(double x, double y) { return number(x) + "," + number(y); }

std::string line(const char* style, double x1, double y1, double x2, double y2)
{
    return "<line class=\"" + std::string(style) + "\" x1=\"" + number(x1) + "\" y1=\"" +
           number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) + "\"/>\n";
}

std::string label(
    const std::string& text, double x, double y, const char* anchor, const std::string& more)
{
    return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\"" +
           more + ">" + xmlEscaped(text) + "</text>\n";
}

std::string turned(const std::string& text, double x, double y)
{
    return label(
        text, x, y, "middle", " transform=\"rotate(-90 " + number(x) + " " + number(y) + ")\"");
}
}  // namespace svg
}  // namespace pointplane
