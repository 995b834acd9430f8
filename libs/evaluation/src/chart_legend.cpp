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

std::string legendOf(const ChartLayout& plot)
{
    std::string out;
    for (const ChartLayout::LegendItem& item : plot.legend)
    {
        const ChartSeries& series = plot.chart.series[item.series];
        const std::string colour = plot.colourOf(series, item.series);
        const double x = item.x;
        const double y = plot.height - plot.legendHeight + item.y + 8;
        const bool filled =
            series.style == ChartSeries::Style::Band || series.style == ChartSeries::Style::Bars;
        if (filled)
        {
            out += "<rect class=\"" +
                   std::string(series.style == ChartSeries::Style::Band ? "band " : "bar ") +
                   colour + "\" x=\"" + number(x) + "\" y=\"" + number(y - 5) +
                   "\" width=\"16\" height=\"10\"/>\n";
        }
        else if (
            series.style == ChartSeries::Style::Start || series.style == ChartSeries::Style::Points)
        {
            out += "<circle class=\"" +
                   std::string(series.style == ChartSeries::Style::Start ? "mark " : "dot ") +
                   colour + "\" cx=\"" + number(x + 8) + "\" cy=\"" + number(y) + "\" r=\"" +
                   (series.style == ChartSeries::Style::Start ? "5" : "2.5") + "\"/>\n";
        }
        else if (series.style == ChartSeries::Style::End)
        {
            out += "<rect class=\"mark " + colour + "\" x=\"" + number(x + 3) + "\" y=\"" +
                   number(y - 5) + "\" width=\"10\" height=\"10\"/>\n";
        }
        else if (!series.level.empty())
        {
            out += "<line class=\"level\" stroke=\"" + levelColour(0.5) + "\" x1=\"" + number(x) +
                   "\" y1=\"" + number(y) + "\" x2=\"" + number(x + 16) + "\" y2=\"" + number(y) +
                   "\"/>\n";
        }
        else
        {
            const std::string style =
                std::string(series.style == ChartSeries::Style::Dashed ? "line dashed " : "line ") +
                colour;
            out += line(style.c_str(), x, y, x + 16, y);
        }
        out += label(series.name, x + 21, y + 4, "start");
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
