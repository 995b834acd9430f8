// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "chart_parts.h"
#include "svg_elements.h"

namespace pointplane
{
namespace
{
using svg::label;
using svg::line;
using svg::turned;

std::string horizontalAxis(const ChartLayout& plot)
{
    std::string out;
    std::vector<ChartTick> ticks = plot.x->ticks(kTickSpacing);
    if (!plot.chart.xNames.empty())
    {
        ticks.clear();
        for (std::size_t k = 0; k < plot.chart.xNames.size(); ++k)
        {
            ticks.push_back({static_cast<double>(k), plot.chart.xNames[k]});
        }
    }
    for (const ChartTick& tick : ticks)
    {
        const double x = plot.x->pixelsOf(tick.value);
        if (!tick.label.empty())
        {
            out += line("grid", x, plot.top, x, plot.bottom) +
                   label(tick.label, x, plot.bottom + 17, "middle");
        }
        out += line("axis", x, plot.bottom, x, plot.bottom + (tick.label.empty() ? 2 : 4));
    }
    return out + line("axis", plot.left, plot.bottom, plot.right, plot.bottom) +
           label(plot.chart.xLabel, 0.5 * (plot.left + plot.right), plot.bottom + 35, "middle");
}

enum class Side
{
    Left,
    Right
};

std::string verticalAxis(const ChartLayout& plot, Side side)
{
    const bool right = side == Side::Right;
    const ChartAxis& axis = right ? *plot.yRight : *plot.y;
    const std::vector<std::string>& names = plot.chart.yNames;
    std::vector<ChartTick> ticks = axis.ticks(plot.chart.equalScales ? kTickSpacing : 32);
    if (!right && !names.empty())
    {
        ticks.clear();
        for (std::size_t k = 0; k < names.size(); ++k)
        {
            ticks.push_back({static_cast<double>(k), names[k]});
        }
    }
    const double at = right ? plot.right : plot.left;
    const double outwards = right ? 1 : -1;
    std::string out;
    for (const ChartTick& tick : ticks)
    {
        const double y = axis.pixelsOf(tick.value);
        if (!right && !tick.label.empty())
        {
            out += line(tick.value == 0 ? "zero" : "grid", plot.left, y, plot.right, y);
        }
        out += line("axis", at, y, at + outwards * (tick.label.empty() ? 2 : 4), y) +
               label(tick.label, at + 7 * outwards, y + 4, right ? "start" : "end");
    }
    return out + line("axis", at, plot.top, at, plot.bottom);
}
}  // namespace

std::string axesOf(const ChartLayout& plot)
{
    const double middle = 0.5 * (plot.top + plot.bottom);
    std::string out = horizontalAxis(plot) + verticalAxis(plot, Side::Left) +
                      turned(plot.chart.yLabel, 13, middle);
    if (!plot.chart.yRightLabel.empty())
    {
        out += verticalAxis(plot, Side::Right) +
               turned(plot.chart.yRightLabel, plot.width - 5, middle);
    }
    return out;
}
}  // namespace pointplane
