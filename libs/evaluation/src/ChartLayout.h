// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Chart.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ChartAxis.h"

namespace pointplane
{
/** Least distance of labels along the horizontal axis [pixels]. */
constexpr double kTickSpacing = 58;

/** Where the parts of a chart are [pixels]. Refers to the chart. */
struct ChartLayout
{
    struct LegendItem
    {
        std::size_t series;
        double x, y;
    };

    explicit ChartLayout(const Chart& theChart);

    [[nodiscard]] const ChartAxis& yOf(const ChartSeries& series) const
    {
        return series.rightAxis ? *yRight : *y;
    }
    /** Class of the series' colour: its own, or the next of the palette. */
    [[nodiscard]] std::string colourOf(const ChartSeries& series, std::size_t index) const;

    const Chart& chart;
    double width, height;
    double left{62}, right{0}, top{12}, bottom{0};  //!< edges of the plot
    std::optional<ChartAxis> x, y, yRight;
    ChartRange level;
    std::vector<LegendItem> legend;
    double legendHeight{0};

 private:
    void placeLegend();
    void placeAxes();
};
}  // namespace pointplane
