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
        Dashed
    };
    std::string name;
    std::vector<double> x, y;
    Style style{Style::Line};
    bool rightAxis{false};
    std::string colour{};  //!< CSS; empty: the next of the palette
};

/** A chart with one horizontal and one or two vertical axes. */
struct Chart
{
    std::string title, xLabel, yLabel;
    std::string yRightLabel{};  //!< empty: no right axis
    std::vector<ChartSeries> series;
    bool equalScales{false};  //!< a metre is as long in both directions (maps)
    bool logX{false}, logY{false};
    std::vector<std::string> xNames{};  //!< for whole numbers on the horizontal axis
    std::vector<std::string> yNames{};  //!< for whole numbers on the left axis, e.g. states
};

/** A report in one HTML file that needs nothing else: no network, no further file. Charts are drawn
 * by Chart.js, which is part of the file; pictures are embedded. Fits a phone and a desk. */
class HtmlReport
{
 public:
    HtmlReport(std::string title, std::string subtitle);

    void addParagraph(const std::string& text);
    void addTable(
        const std::string& caption,
        const std::vector<std::string>& header,
        const std::vector<std::vector<std::string>>& rows);
    /** Long series are thinned out to some thousand points; extremes stay. */
    void addChart(const Chart& chart);
    /** Embeds a PNG or JPEG file; throws std::runtime_error naming it when it cannot be read. */
    void addPicture(const std::string& caption, const std::string& path);

    [[nodiscard]] std::string html() const;

 private:
    std::string title_, subtitle_;
    std::string body_;
    std::vector<std::string> charts_;  //!< JSON
};
}  // namespace pointplane
