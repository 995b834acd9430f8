// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/svg_chart.h>

#include "chart_parts.h"
#include "short_number.h"
#include "svg_elements.h"

namespace pointplane
{
namespace
{
std::string scaleOf(double from, double to, const ChartAxis& axis)
{
    return shortNumber(from) + " " + shortNumber(to) + " " + shortNumber(axis.min()) + " " +
           shortNumber(axis.max()) + (axis.logarithmic() ? " 1" : " 0");
}

using svg::number;

std::string elementOf(const Chart& chart, const std::string& attributes, const std::string& style)
{
    const ChartLayout plot(chart);
    const std::string size = number(plot.width) + " " + number(plot.height);
    std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" viewBox=\"0 0 " +
                      size + "\"" + attributes + " role=\"img\" aria-label=\"" +
                      xmlEscaped(chart.title) + "\">\n";
    out += style.empty() ? "" : "<style>" + style + "</style>\n";
    out += axesOf(plot);
    for (std::size_t k = 0; k < chart.series.size(); ++k)
    {
        const ChartSeries& series = chart.series[k];
        // For the pointer: whose the points are and what their pixels mean.
        const ChartAxis& y = plot.yOf(series);
        const std::string scale =
            scaleOf(plot.left, plot.right, *plot.x) + " " + scaleOf(plot.bottom, plot.top, y);
        out += "<g data-name=\"" + xmlEscaped(series.name) + "\" data-scale=\"" + scale + "\">\n" +
               seriesOf(plot, k) + "</g>\n";
    }
    return out + colourBarOf(plot) + legendOf(plot) + "</svg>\n";
}
}  // namespace

std::string svgOf(const Chart& chart) { return elementOf(chart, "", ""); }

std::string svgFileOf(const Chart& chart)
{
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" +
           elementOf(chart, " style=\"background:#fff\"", chartStyle(false));
}
}  // namespace pointplane
