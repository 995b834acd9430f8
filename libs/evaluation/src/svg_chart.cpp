// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/svg_chart.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "ChartAxis.h"
#include "chart_colours.h"
#include "svg_elements.h"
#include "thinned.h"

namespace pointplane
{
namespace
{
using svg::label;
using svg::line;
using svg::number;
using svg::point;
using svg::turned;

constexpr double kLetterWidth = 6.6;  // mean, a little too large
constexpr double kTickSpacing = 58;
constexpr std::size_t kLevels = 32;

/** Draws one chart. */
class Drawing
{
 public:
    explicit Drawing(const Chart& chart);
    [[nodiscard]] std::string svg(const std::string& attributes, const std::string& style) const;

 private:
    void layOut();
    [[nodiscard]] std::string axes() const;
    [[nodiscard]] std::string horizontalAxis() const;
    [[nodiscard]] std::string verticalAxis(
        const ChartAxis& axis, const std::vector<std::string>& names, bool right) const;
    [[nodiscard]] std::string seriesOf(const ChartSeries& series, std::size_t index) const;
    [[nodiscard]] std::string polylines(
        const ChartSeries& series, const std::string& style, bool stepped) const;
    [[nodiscard]] std::string levels(const ChartSeries& series) const;
    [[nodiscard]] std::string band(const ChartSeries& series, const std::string& colour) const;
    [[nodiscard]] std::string bars(const ChartSeries& series, const std::string& colour) const;
    [[nodiscard]] std::string marks(const ChartSeries& series, const std::string& colour) const;
    [[nodiscard]] std::string legend() const;
    [[nodiscard]] std::string colourBar() const;
    [[nodiscard]] std::string colourOf(const ChartSeries& series, std::size_t index) const;
    [[nodiscard]] const ChartAxis& yOf(const ChartSeries& series) const
    {
        return series.rightAxis ? *yRight_ : *y_;
    }
    struct LegendItem
    {
        std::size_t series;
        double x, y;
    };
    void layOutLegend();

    const Chart& chart_;
    double width_, height_;
    double left_, right_, top_, bottom_;  //!< edges of the plot
    std::optional<ChartAxis> x_, y_, yRight_;
    ChartRange level_;
    std::vector<LegendItem> legend_;
    double legendHeight_{0};
};

Drawing::Drawing(const Chart& chart)
    : chart_(chart),
      width_(chart.small ? 380 : 580),
      height_(chart.equalScales ? 560 : (chart.small ? 230 : 320))
{
    for (const ChartSeries& series : chart.series)
    {
        for (const double value : series.level)
        {
            level_.add(value);
        }
    }
    left_ = 62;
    right_ = width_ - (chart.yRightLabel.empty() ? 14 : 56) - (level_.empty ? 0 : 60);
    top_ = 12;
    layOutLegend();
    bottom_ = height_ - 44 - legendHeight_;
    layOut();
}

void Drawing::layOutLegend()
{
    double x = left_;
    double y = 0;
    for (std::size_t k = 0; k < chart_.series.size(); ++k)
    {
        const std::string& name = chart_.series[k].name;
        if (name.empty())
        {
            continue;
        }
        const double width = 36 + kLetterWidth * static_cast<double>(name.size());
        if (x > left_ && x + width > width_)
        {
            x = left_;
            y += 17;
        }
        legend_.push_back({k, x, y});
        x += width;
    }
    legendHeight_ = legend_.empty() ? 0 : y + 17;
}

void Drawing::layOut()
{
    ChartRange x;
    ChartRange y;
    ChartRange right;
    for (const ChartSeries& series : chart_.series)
    {
        ChartRange& range = series.rightAxis ? right : y;
        for (std::size_t k = 0; k < series.y.size(); ++k)
        {
            if (std::isfinite(series.y[k]) && !(chart_.logY && series.y[k] <= 0))
            {
                x.add(series.x[k]);
                range.add(series.y[k]);
            }
        }
        for (const double value : series.yUpper)
        {
            range.add(value);
        }
        if (series.style == ChartSeries::Style::Bars)
        {
            x.add(series.x.back());
            range.add(0);
        }
    }
    if (chart_.yFromZero || !chart_.yRightLabel.empty())
    {
        y.add(0);
        right.add(0);
    }
    const auto named = [](const std::vector<std::string>& names, double margin, ChartRange& range)
    {
        if (!names.empty())
        {
            range = {-margin, static_cast<double>(names.size()) - 1 + margin, false};
        }
    };
    named(chart_.xNames, 0.2, x);
    named(chart_.yNames, 0.5, y);
    if (chart_.equalScales)
    {
        // Room for marks and line widths; then the shorter range grows until scales are equal.
        const double perPixel = std::max(
            {(x.max - x.min) / (right_ - left_ - 24),
             (y.max - y.min) / (bottom_ - top_ - 24),
             1e-9});
        const auto grow = [&](ChartRange& range, double pixels)
        {
            const double middle = 0.5 * (range.min + range.max);
            range = {middle - 0.5 * perPixel * pixels, middle + 0.5 * perPixel * pixels, false};
        };
        grow(x, right_ - left_);
        grow(y, bottom_ - top_);
    }
    x_.emplace(x, chart_.logX, left_, right_);
    y_.emplace(y, chart_.logY, bottom_, top_);
    yRight_.emplace(right, false, bottom_, top_);
}

std::string Drawing::colourOf(const ChartSeries& series, std::size_t index) const
{
    std::size_t inPalette = 0;
    for (std::size_t k = 0; k < index; ++k)
    {
        inPalette += chart_.series[k].colour.empty() ? 1 : 0;
    }
    return colourClass(series.colour, inPalette);
}

std::string Drawing::horizontalAxis() const
{
    std::string out;
    std::vector<ChartTick> ticks = x_->ticks(kTickSpacing);
    if (!chart_.xNames.empty())
    {
        ticks.clear();
        for (std::size_t k = 0; k < chart_.xNames.size(); ++k)
        {
            ticks.push_back({static_cast<double>(k), chart_.xNames[k]});
        }
    }
    for (const ChartTick& tick : ticks)
    {
        const double x = x_->pixelsOf(tick.value);
        if (!tick.label.empty())
        {
            out += line("grid", x, top_, x, bottom_) + label(tick.label, x, bottom_ + 17, "middle");
        }
        out += line("axis", x, bottom_, x, bottom_ + (tick.label.empty() ? 2 : 4));
    }
    return out + line("axis", left_, bottom_, right_, bottom_) +
           label(chart_.xLabel, 0.5 * (left_ + right_), bottom_ + 35, "middle");
}

std::string Drawing::verticalAxis(
    const ChartAxis& axis, const std::vector<std::string>& names, bool right) const
{
    std::vector<ChartTick> ticks = axis.ticks(chart_.equalScales ? kTickSpacing : 32);
    if (!names.empty())
    {
        ticks.clear();
        for (std::size_t k = 0; k < names.size(); ++k)
        {
            ticks.push_back({static_cast<double>(k), names[k]});
        }
    }
    const double at = right ? right_ : left_;
    const double outwards = right ? 1 : -1;
    std::string out;
    for (const ChartTick& tick : ticks)
    {
        const double y = axis.pixelsOf(tick.value);
        if (!right && !tick.label.empty())
        {
            out += line(tick.value == 0 ? "zero" : "grid", left_, y, right_, y);
        }
        out += line("axis", at, y, at + outwards * (tick.label.empty() ? 2 : 4), y) +
               label(tick.label, at + 7 * outwards, y + 4, right ? "start" : "end");
    }
    return out + line("axis", at, top_, at, bottom_);
}

std::string Drawing::axes() const
{
    const double middle = 0.5 * (top_ + bottom_);
    std::string out = horizontalAxis() + verticalAxis(*y_, chart_.yNames, false) +
                      turned(chart_.yLabel, 13, middle);
    if (!chart_.yRightLabel.empty())
    {
        out += verticalAxis(*yRight_, {}, true) + turned(chart_.yRightLabel, width_ - 5, middle);
    }
    return out;
}

std::string Drawing::polylines(
    const ChartSeries& series, const std::string& style, bool stepped) const
{
    const ChartAxis& y = yOf(series);
    std::string out;
    std::string points;
    double before = 0;
    const auto finish = [&]
    {
        if (!points.empty())
        {
            out += "<polyline class=\"" + style + "\" points=\"" + points + "\"/>\n";
        }
        points.clear();
    };
    for (const std::size_t k : thinned(series.y))
    {
        if (!std::isfinite(series.y[k]) || (y.logarithmic() && series.y[k] <= 0))
        {
            finish();
            continue;
        }
        const double px = x_->pixelsOf(series.x[k]);
        const double py = y.pixelsOf(series.y[k]);
        if (stepped && !points.empty())
        {
            points += point(px, before) + " ";
        }
        points += point(px, py) + " ";
        before = py;
    }
    finish();
    return out;
}

/** Runs of points with about the same level are one line. */
std::string Drawing::levels(const ChartSeries& series) const
{
    const auto binOf = [&](std::size_t k)
    {
        const double f = (series.level[k] - level_.min) / std::max(1e-300, level_.max - level_.min);
        return std::isfinite(f) ? std::lround(f * (kLevels - 1)) : 0;
    };
    const std::vector<std::size_t> keep = thinned(series.y);
    std::string out;
    for (std::size_t begin = 0; begin + 1 < keep.size();)
    {
        const long bin = binOf(keep[begin]);
        std::size_t end = begin + 1;
        while (end + 1 < keep.size() && binOf(keep[end]) == bin)
        {
            ++end;
        }
        out += "<polyline class=\"level\" stroke=\"" +
               levelColour(static_cast<double>(bin) / (kLevels - 1)) + "\" points=\"";
        for (std::size_t k = begin; k <= end; ++k)
        {
            out += point(x_->pixelsOf(series.x[keep[k]]), y_->pixelsOf(series.y[keep[k]])) + " ";
        }
        out += "\"/>\n";
        begin = end;
    }
    return out;
}

std::string Drawing::band(const ChartSeries& series, const std::string& colour) const
{
    const ChartAxis& y = yOf(series);
    std::string points;
    const std::vector<std::size_t> keep = thinned(series.y);
    for (const std::size_t k : keep)
    {
        points += point(x_->pixelsOf(series.x[k]), y.pixelsOf(series.y[k])) + " ";
    }
    for (auto k = keep.rbegin(); k != keep.rend(); ++k)
    {
        points += point(x_->pixelsOf(series.x[*k]), y.pixelsOf(series.yUpper[*k])) + " ";
    }
    return "<polygon class=\"band " + colour + "\" points=\"" + points + "\"/>\n";
}

std::string Drawing::bars(const ChartSeries& series, const std::string& colour) const
{
    const ChartAxis& y = yOf(series);
    std::string out;
    for (std::size_t k = 0; k + 1 < series.x.size(); ++k)
    {
        const double from = x_->pixelsOf(series.x[k]);
        const double width = x_->pixelsOf(series.x[k + 1]) - from;
        const double height = y.pixelsOf(0) - y.pixelsOf(series.y[k]);
        out += "<rect class=\"bar " + colour + "\" x=\"" + number(from + 0.5) + "\" y=\"" +
               number(y.pixelsOf(series.y[k])) + "\" width=\"" + number(std::max(0.5, width - 1)) +
               "\" height=\"" + number(height) + "\"/>\n";
    }
    return out;
}

std::string Drawing::marks(const ChartSeries& series, const std::string& colour) const
{
    using Style = ChartSeries::Style;
    const bool large = series.style == Style::Start || series.style == Style::End;
    const double r = large ? 6 : series.style == Style::Line ? 2.6 : 1.8;
    std::string out;
    for (const std::size_t k : thinned(series.y))
    {
        if (!std::isfinite(series.y[k]) || (yOf(series).logarithmic() && series.y[k] <= 0))
        {
            continue;
        }
        const double x = x_->pixelsOf(series.x[k]);
        const double y = yOf(series).pixelsOf(series.y[k]);
        const std::string style = std::string(large ? "mark " : "dot ") + colour;
        out += series.style == ChartSeries::Style::End
                   ? "<rect class=\"" + style + "\" x=\"" + number(x - r) + "\" y=\"" +
                         number(y - r) + "\" width=\"12\" height=\"12\"/>\n"
                   : "<circle class=\"" + style + "\" cx=\"" + number(x) + "\" cy=\"" + number(y) +
                         "\" r=\"" + number(r) + "\"/>\n";
    }
    return out;
}

std::string Drawing::seriesOf(const ChartSeries& series, std::size_t index) const
{
    const std::string colour = colourOf(series, index);
    switch (series.style)
    {
        case ChartSeries::Style::Line:
        {
            constexpr std::size_t kFew = 40;  // whose points can be told apart
            const std::string dots =
                series.x.size() < kFew && series.colour.empty() ? marks(series, colour) : "";
            return series.level.empty() ? polylines(series, "line " + colour, false) + dots
                                        : levels(series);
        }
        case ChartSeries::Style::Steps:
            return polylines(series, "line " + colour, true);
        case ChartSeries::Style::Dashed:
            return polylines(series, "line dashed " + colour, false);
        case ChartSeries::Style::Band:
            return band(series, colour);
        case ChartSeries::Style::Bars:
            return bars(series, colour);
        case ChartSeries::Style::Points:
        case ChartSeries::Style::Start:
        case ChartSeries::Style::End:
            return marks(series, colour);
    }
    return "";
}

std::string Drawing::legend() const
{
    std::string out;
    for (const LegendItem& item : legend_)
    {
        const ChartSeries& series = chart_.series[item.series];
        const std::string colour = colourOf(series, item.series);
        const double x = item.x;
        const double y = height_ - legendHeight_ + item.y + 8;
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

std::string Drawing::colourBar() const
{
    if (level_.empty)
    {
        return "";
    }
    const double x = right_ + 14;
    const ChartAxis axis(level_, false, bottom_, top_);
    std::string out;
    const double step = (bottom_ - top_) / kLevels;
    for (std::size_t k = 0; k < kLevels; ++k)
    {
        out += "<rect x=\"" + number(x) + "\" y=\"" +
               number(bottom_ - step * static_cast<double>(k + 1)) + "\" width=\"10\" height=\"" +
               number(step + 0.6) + "\" fill=\"" +
               levelColour(static_cast<double>(k) / (kLevels - 1)) + "\"/>\n";
    }
    for (const ChartTick& tick : axis.ticks(kTickSpacing))
    {
        out += label(tick.label, x + 14, axis.pixelsOf(tick.value) + 4, "start");
    }
    return out + turned(chart_.levelLabel, width_ - 5, 0.5 * (top_ + bottom_));
}

std::string Drawing::svg(const std::string& attributes, const std::string& style) const
{
    const std::string size = number(width_) + " " + number(height_);
    std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" viewBox=\"0 0 " +
                      size + "\"" + attributes + " role=\"img\" aria-label=\"" +
                      xmlEscaped(chart_.title) + "\">\n";
    out += style.empty() ? "" : "<style>" + style + "</style>\n";
    out += axes();
    for (std::size_t k = 0; k < chart_.series.size(); ++k)
    {
        const ChartSeries& series = chart_.series[k];
        // For the pointer: whose the points are and what their pixels mean.
        const ChartAxis& y = yOf(series);
        char scale[256];
        std::snprintf(
            scale,
            sizeof scale,
            "%g %g %g %g %d %g %g %g %g %d",
            left_,
            right_,
            x_->min(),
            x_->max(),
            x_->logarithmic() ? 1 : 0,
            bottom_,
            top_,
            y.min(),
            y.max(),
            y.logarithmic() ? 1 : 0);
        out += "<g data-name=\"" + xmlEscaped(series.name) + "\" data-scale=\"" + scale + "\">\n" +
               seriesOf(series, k) + "</g>\n";
    }
    return out + colourBar() + legend() + "</svg>\n";
}
}  // namespace

std::string svgOf(const Chart& chart) { return Drawing(chart).svg("", ""); }

std::string svgFileOf(const Chart& chart)
{
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" +
           Drawing(chart).svg(" style=\"background:#fff\"", chartStyle(false));
}
}  // namespace pointplane
