// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace pointplane
{
/** One curve or cloud of points of a chart. A NaN in y interrupts the line. */
struct ChartSeries
{
    enum class Style
    {
        Line,
        Points,
        Steps,
        Dashed,
        Band,   //!< the area between y and yUpper
        Bars,   //!< a histogram: bar k from x[k] to x[k + 1]; the last y is ignored
        Start,  //!< marks points by a circle
        End     //!< marks points by a square
    };
    std::string name;  //!< in the legend, unless it is empty
    std::vector<double> x, y;
    Style style{Style::Line};
    bool rightAxis{false};
    /** "ink" (that of the text), "muted", "accent" or "alarm"; empty: the next of the palette. */
    std::string colour{};
    std::vector<double> yUpper{};  //!< of a band
    std::vector<double> level{};   //!< empty, or a value per point that colours the line
};

/** A chart with one horizontal and one or two vertical axes. Axes end with the data. */
struct Chart
{
    std::string title, xLabel, yLabel;
    std::string yRightLabel{};  //!< empty: no right axis
    std::vector<ChartSeries> series;
    bool equalScales{false};  //!< a metre is as long in both directions (maps)
    bool logX{false}, logY{false};
    bool yFromZero{false};              //!< the left axis starts at zero
    std::vector<std::string> xNames{};  //!< for whole numbers on the horizontal axis
    std::vector<std::string> yNames{};  //!< for whole numbers on the left axis, e.g. states
    std::string levelLabel{};           //!< of the colour bar of series with levels
    bool small{false};                  //!< three of them in a row instead of two
};
}  // namespace pointplane
