// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include "chart_colours.h"
#include "chart_parts.h"
#include "svg_elements.h"
#include "thinned.h"

namespace pointplane
{
namespace
{
using svg::number;
using svg::point;

std::string polylines(const ChartLayout& plot, const ChartSeries& series, const std::string& style)
{
    const ChartAxis& y = plot.yOf(series);
    std::string out;
    std::string points;
    std::size_t count = 0;
    double before = 0;
    const auto finish = [&]
    {
        if (count > 0)
        {
            // A line of one point is a dot.
            out += "<polyline class=\"" + style + (count == 1 ? " alone" : "") + "\" points=\"" +
                   points + (count == 1 ? points : "") + "\"/>\n";
        }
        points.clear();
        count = 0;
    };
    for (const std::size_t k : thinned(series.y))
    {
        if (!std::isfinite(series.y[k]) || (y.logarithmic() && series.y[k] <= 0))
        {
            finish();
            continue;
        }
        const double px = plot.x->pixelsOf(series.x[k]);
        const double py = y.pixelsOf(series.y[k]);
        if (series.style == ChartSeries::Style::Steps && !points.empty())
        {
            points += point(px, before) + " ";
        }
        points += point(px, py) + " ";
        ++count;
        before = py;
    }
    finish();
    return out;
}

/** Runs of points with about the same level are one line. */
std::string levels(const ChartLayout& plot, const ChartSeries& series)
{
    const auto binOf = [&](std::size_t k)
    {
        const double f =
            (series.level[k] - plot.level.min) / std::max(1e-300, plot.level.max - plot.level.min);
        return std::isfinite(f) ? std::lround(f * (kLevels - 1)) : 0;
    };
    const std::vector<std::size_t> keep = thinned(series.y);
    const auto isHole = [&](std::size_t n) { return !std::isfinite(series.y[keep[n]]); };
    std::string out;
    const auto isLast = [&](std::size_t n) { return n + 1 == keep.size() || isHole(n + 1); };
    const auto isFirst = [&](std::size_t n) { return n == 0 || isHole(n - 1); };
    for (std::size_t begin = 0; begin < keep.size();)
    {
        if (isHole(begin) || (isLast(begin) && !isFirst(begin)))
        {
            ++begin;
            continue;
        }
        const long bin = binOf(keep[begin]);
        std::size_t end = isLast(begin) ? begin : begin + 1;  // one point alone is a dot
        while (!isLast(end) && binOf(keep[end]) == bin)
        {
            ++end;
        }
        out += "<polyline class=\"level\" stroke=\"" +
               levelColour(static_cast<double>(bin) / (kLevels - 1)) + "\" points=\"";
        for (std::size_t n = begin; n <= std::max(end, begin + 1); ++n)
        {
            const std::size_t k = keep[std::min(n, end)];
            out += point(plot.x->pixelsOf(series.x[k]), plot.y->pixelsOf(series.y[k])) + " ";
        }
        out += "\"/>\n";
        begin = std::max(end, begin + 1);
    }
    return out;
}

/** One area per line without holes. */
std::string band(const ChartLayout& plot, const ChartSeries& series, const std::string& colour)
{
    const ChartAxis& y = plot.yOf(series);
    const std::vector<std::size_t> keep = thinned(series.y);
    const auto isHole = [&](std::size_t k) { return !std::isfinite(series.y[k]); };
    std::string out;
    for (auto begin = keep.begin(); begin != keep.end();)
    {
        begin = std::find_if_not(begin, keep.end(), isHole);
        const auto end = std::find_if(begin, keep.end(), isHole);
        std::string points;
        for (auto k = begin; k != end; ++k)
        {
            points += point(plot.x->pixelsOf(series.x[*k]), y.pixelsOf(series.y[*k])) + " ";
        }
        for (auto k = end; k != begin;)
        {
            --k;
            points += point(plot.x->pixelsOf(series.x[*k]), y.pixelsOf(series.yUpper[*k])) + " ";
        }
        if (!points.empty())
        {
            out += "<polygon class=\"band " + colour + "\" points=\"" + points + "\"/>\n";
        }
        begin = end;
    }
    return out;
}

std::string bars(const ChartLayout& plot, const ChartSeries& series, const std::string& colour)
{
    const ChartAxis& y = plot.yOf(series);
    std::string out;
    for (std::size_t k = 0; k + 1 < series.x.size(); ++k)
    {
        const double from = plot.x->pixelsOf(series.x[k]);
        const double width = plot.x->pixelsOf(series.x[k + 1]) - from;
        const double height = y.pixelsOf(0) - y.pixelsOf(series.y[k]);
        out += "<rect class=\"bar " + colour + "\" x=\"" + number(from + 0.5) + "\" y=\"" +
               number(y.pixelsOf(series.y[k])) + "\" width=\"" + number(std::max(0.5, width - 1)) +
               "\" height=\"" + number(height) + "\"/>\n";
    }
    return out;
}

std::string marks(const ChartLayout& plot, const ChartSeries& series, const std::string& colour)
{
    using Style = ChartSeries::Style;
    const bool large = series.style == Style::Start || series.style == Style::End;
    const double r = large ? 6 : series.style == Style::Line ? 2.6 : 1.8;
    std::string out;
    for (const std::size_t k : thinned(series.y))
    {
        if (!std::isfinite(series.y[k]) || (plot.yOf(series).logarithmic() && series.y[k] <= 0))
        {
            continue;
        }
        const double x = plot.x->pixelsOf(series.x[k]);
        const double y = plot.yOf(series).pixelsOf(series.y[k]);
        const std::string style = std::string(large ? "mark " : "dot ") + colour;
        out += series.style == ChartSeries::Style::End
                   ? "<rect class=\"" + style + "\" x=\"" + number(x - r) + "\" y=\"" +
                         number(y - r) + "\" width=\"12\" height=\"12\"/>\n"
                   : "<circle class=\"" + style + "\" cx=\"" + number(x) + "\" cy=\"" + number(y) +
                         "\" r=\"" + number(r) + "\"/>\n";
    }
    return out;
}
}  // namespace

std::string seriesOf(const ChartLayout& plot, std::size_t index)
{
    const ChartSeries& series = plot.chart.series[index];
    const std::string colour = plot.colourOf(series, index);
    switch (series.style)
    {
        case ChartSeries::Style::Line:
        {
            constexpr std::size_t kFew = 40;  // whose points can be told apart
            const std::string dots =
                series.x.size() < kFew && series.colour.empty() ? marks(plot, series, colour) : "";
            return series.level.empty() ? polylines(plot, series, "line " + colour) + dots
                                        : levels(plot, series);
        }
        case ChartSeries::Style::Steps:
            return polylines(plot, series, "line " + colour);
        case ChartSeries::Style::Dashed:
            return polylines(plot, series, "line dashed " + colour);
        case ChartSeries::Style::Band:
            return band(plot, series, colour);
        case ChartSeries::Style::Bars:
            return bars(plot, series, colour);
        case ChartSeries::Style::Points:
        case ChartSeries::Style::Start:
        case ChartSeries::Style::End:
            return marks(plot, series, colour);
    }
    return "";
}
}  // namespace pointplane
