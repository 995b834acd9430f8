// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>

#include "chart_colours.h"
#include "chart_parts.h"
#include "svg_elements.h"

namespace pointplane
{
using svg::label;
using svg::line;
using svg::number;
using svg::turned;

namespace
{
/** What stands for a series: 16 wide. \param x its left end \param y its middle */
std::string symbolOf(const ChartSeries& series, const std::string& colour, double x, double y)
{
    using Style = ChartSeries::Style;
    const auto is = [&](Style style) { return series.style == style; };
    if (is(Style::Band) || is(Style::Bars))
    {
        return "<rect class=\"" + std::string(is(Style::Band) ? "band " : "bar ") + colour +
               "\" x=\"" + number(x) + "\" y=\"" + number(y - 5) +
               "\" width=\"16\" height=\"10\"/>\n";
    }
    if (is(Style::Start) || is(Style::Points))
    {
        return "<circle class=\"" + std::string(is(Style::Start) ? "mark " : "dot ") + colour +
               "\" cx=\"" + number(x + 8) + "\" cy=\"" + number(y) + "\" r=\"" +
               (is(Style::Start) ? "5" : "2.5") + "\"/>\n";
    }
    if (is(Style::End))
    {
        return "<rect class=\"mark " + colour + "\" x=\"" + number(x + 3) + "\" y=\"" +
               number(y - 5) + "\" width=\"10\" height=\"10\"/>\n";
    }
    if (!series.level.empty())
    {
        return "<line class=\"level\" stroke=\"" + levelColour(0.5) + "\" x1=\"" + number(x) +
               "\" y1=\"" + number(y) + "\" x2=\"" + number(x + 16) + "\" y2=\"" + number(y) +
               "\"/>\n";
    }
    const std::string style = std::string(is(Style::Dashed) ? "line dashed " : "line ") + colour;
    return line(style.c_str(), x, y, x + 16, y);
}
}  // namespace

std::string legendOf(const ChartLayout& plot)
{
    std::string out;
    for (const ChartLayout::LegendItem& item : plot.legend)
    {
        const ChartSeries& series = plot.chart.series[item.series];
        const double y = plot.height - plot.legendHeight + item.y + 8;
        out += symbolOf(series, plot.colourOf(series, item.series), item.x, y);
        out += label(series.name, item.x + 21, y + 4, "start");
    }
    return out;
}

std::string colourBarOf(const ChartLayout& plot)
{
    if (plot.level.empty)
    {
        return "";
    }
    const double x = plot.right + 14;
    const ChartAxis axis(plot.level, false, plot.bottom, plot.top);
    std::string out;
    const double step = (plot.bottom - plot.top) / kLevels;
    for (std::size_t k = 0; k < kLevels; ++k)
    {
        out += "<rect x=\"" + number(x) + "\" y=\"" +
               number(plot.bottom - step * static_cast<double>(k + 1)) +
               "\" width=\"10\" height=\"" + number(step + 0.6) + "\" fill=\"" +
               levelColour(static_cast<double>(k) / (kLevels - 1)) + "\"/>\n";
    }
    for (const ChartTick& tick : axis.ticks(kTickSpacing))
    {
        out += label(tick.label, x + 14, axis.pixelsOf(tick.value) + 4, "start");
    }
    return out + turned(plot.chart.levelLabel, plot.width - 5, 0.5 * (plot.top + plot.bottom));
}
}  // namespace pointplane
