// SPDX-License-Identifier: BSD-3-Clause
#include "ChartLayout.h"

#include <algorithm>
#include <cmath>

#include "chart_colours.h"

namespace pointplane
{
namespace
{
constexpr double kLetterWidth = 6.6;  // mean, a little too large

/** \param y of the series' axis */
void addSeries(const ChartSeries& series, bool logY, ChartRange& x, ChartRange& y)
{
    for (std::size_t k = 0; k < series.y.size(); ++k)
    {
        if (std::isfinite(series.y[k]) && !(logY && series.y[k] <= 0))
        {
            x.add(series.x[k]);
            y.add(series.y[k]);
        }
    }
    for (const double value : series.yUpper)
    {
        y.add(value);
    }
    if (series.style == ChartSeries::Style::Bars)
    {
        x.add(series.x.back());
        y.add(0);
    }
}

/** Room for marks and line widths; then the shorter range grows until scales are equal.
 * \param width, height of the plot [pixels] */
void makeScalesEqual(ChartRange& x, double width, ChartRange& y, double height)
{
    const double perPixel =
        std::max({(x.max - x.min) / (width - 24), (y.max - y.min) / (height - 24), 1e-9});
    const auto grow = [&](ChartRange& range, double pixels)
    {
        const double middle = 0.5 * (range.min + range.max);
        range = {middle - 0.5 * perPixel * pixels, middle + 0.5 * perPixel * pixels, false};
    };
    grow(x, width);
    grow(y, height);
}
}  // namespace

ChartLayout::ChartLayout(const Chart& theChart)
    : chart(theChart),
      width(theChart.small ? 380 : 580),
      height(theChart.equalScales ? 560 : (theChart.small ? 230 : 320))
{
    for (const ChartSeries& series : chart.series)
    {
        for (const double value : series.level)
        {
            level.add(value);
        }
    }
    right = width - (chart.yRightLabel.empty() ? 14 : 56) - (level.empty ? 0 : 60);
    placeLegend();
    bottom = height - 44 - legendHeight;
    placeAxes();
}

void ChartLayout::placeLegend()
{
    double at = left;
    double below = 0;
    for (std::size_t k = 0; k < chart.series.size(); ++k)
    {
        const std::string& name = chart.series[k].name;
        if (name.empty())
        {
            continue;
        }
        const double needed = 36 + kLetterWidth * static_cast<double>(name.size());
        if (at > left && at + needed > width)
        {
            at = left;
            below += 17;
        }
        legend.push_back({k, at, below});
        at += needed;
    }
    legendHeight = legend.empty() ? 0 : below + 17;
}

void ChartLayout::placeAxes()
{
    ChartRange xRange;
    ChartRange yRange;
    ChartRange rightRange;
    for (const ChartSeries& series : chart.series)
    {
        addSeries(series, chart.logY, xRange, series.rightAxis ? rightRange : yRange);
    }
    if (chart.yFromZero || !chart.yRightLabel.empty())
    {
        yRange.add(0);
        rightRange.add(0);
    }
    const auto named = [](const std::vector<std::string>& names, double margin, ChartRange& range)
    {
        if (!names.empty())
        {
            range = {-margin, static_cast<double>(names.size()) - 1 + margin, false};
        }
    };
    named(chart.xNames, 0.2, xRange);
    named(chart.yNames, 0.5, yRange);
    if (chart.equalScales)
    {
        makeScalesEqual(xRange, right - left, yRange, bottom - top);
    }
    x.emplace(xRange, chart.logX, left, right);
    y.emplace(yRange, chart.logY, bottom, top);
    yRight.emplace(rightRange, false, bottom, top);
}

std::string ChartLayout::colourOf(const ChartSeries& series, std::size_t index) const
{
    std::size_t inPalette = 0;
    for (std::size_t k = 0; k < index; ++k)
    {
        inPalette += chart.series[k].colour.empty() ? 1 : 0;
    }
    return colourClass(series.colour, inPalette);
}
}  // namespace pointplane
