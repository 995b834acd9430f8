// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/svg_chart.h>

#include <cmath>
#include <limits>
#include <regex>

#include "ChartAxis.h"
#include "thinned.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;
using testing::HasSubstr;
using testing::Not;

namespace
{
std::vector<std::string> labelsOf(const ChartAxis& axis, double spacing)
{
    std::vector<std::string> out;
    for (const ChartTick& tick : axis.ticks(spacing))
    {
        if (!tick.label.empty())
        {
            out.push_back(tick.label);
        }
    }
    return out;
}

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t n = 0;
    for (std::size_t p = 0; (p = text.find(part, p)) != std::string::npos; ++p)
    {
        ++n;
    }
    return n;
}

Chart chartOf(const ChartSeries& series)
{
    Chart chart;
    chart.title = "a <title>";
    chart.series.push_back(series);
    return chart;
}
}  // namespace

TEST(ChartAxis, endsWithTheDataAndHasRoundTicks)
{
    const ChartAxis axis({-0.37, 12.31, false}, false, 100, 500);
    EXPECT_EQ(axis.pixelsOf(-0.37), 100);
    EXPECT_EQ(axis.pixelsOf(12.31), 500);
    EXPECT_THAT(labelsOf(axis, 60), testing::ElementsAre("0", "2", "4", "6", "8", "10", "12"));
    EXPECT_THAT(
        labelsOf(ChartAxis({0.011, 0.049, false}, false, 300, 0), 60),
        testing::ElementsAre("0.02", "0.03", "0.04"));
}

TEST(ChartAxis, logarithmicTicks)
{
    const ChartAxis axis({0.1, 5, false}, true, 0, 400);
    EXPECT_NEAR(axis.pixelsOf(std::sqrt(0.5)), 200, 1e-9);
    EXPECT_THAT(labelsOf(axis, 40), testing::ElementsAre("0.1", "0.2", "0.5", "1", "2", "5"));
    const ChartAxis wide({1e-4, 1e4, false}, true, 0, 300);
    EXPECT_THAT(labelsOf(wide, 40), testing::Contains("0.01"));
    EXPECT_THAT(labelsOf(wide, 40), Not(testing::Contains("0.02")));
}

/** Without them, nobody could read how large a value is. */
TEST(ChartAxis, thereAreTwoLabelsAtLeast)
{
    EXPECT_THAT(
        labelsOf(ChartAxis({-0.0497, 0.0497, false}, false, 0, 118), 40),
        testing::ElementsAre("-0.04", "-0.02", "0.00", "0.02", "0.04"));
    EXPECT_THAT(
        labelsOf(ChartAxis({0.21, 0.45, false}, true, 0, 118), 40),
        testing::ElementsAre("0.3", "0.4"));
    for (const double width : {1e-9, 1e-3, 0.3, 0.9, 1.7, 40.0})
    {
        for (const bool logarithmic : {false, true})
        {
            const ChartAxis axis({7.123, 7.123 + width, false}, logarithmic, 0, 60);
            EXPECT_GE(labelsOf(axis, 60).size(), 2U) << width;
        }
    }
}

TEST(ChartAxis, constantAndMissingDataHaveAnAxis)
{
    for (const ChartRange& range : {ChartRange{}, ChartRange{3, 3, false}, ChartRange{0, 0, false}})
    {
        const ChartAxis axis(range, false, 0, 100);
        EXPECT_LT(axis.min(), axis.max());
        EXPECT_FALSE(axis.ticks(20).empty());
    }
}

TEST(SvgChart, drawsPointsWhereTheyAre)
{
    const std::string svg = svgOf(chartOf({"line", {0, 10}, {5, 6}}));
    EXPECT_THAT(svg, HasSubstr("points=\"62,259 566,12 \""));  // corners of the plot
    EXPECT_THAT(svg, HasSubstr(">line</text>"));
    EXPECT_THAT(svg, HasSubstr("aria-label=\"a &lt;title&gt;\""));
}

TEST(SvgChart, gapsInterruptLines)
{
    const double gap = std::numeric_limits<double>::quiet_NaN();
    const std::string svg = svgOf(chartOf({"line", {0, 1, 2, 3, 4}, {0, 1, gap, 1, 0}}));
    EXPECT_EQ(count(svg, "<polyline"), 2u);
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(SvgChart, escapesNames)
{
    Chart chart = chartOf({"<!--<script>\"&", {0, 1}, {0, 1}});
    chart.xLabel = "<x>";
    const std::string svg = svgOf(chart);
    EXPECT_THAT(svg, HasSubstr("&lt;!--&lt;script&gt;&quot;&amp;"));
    EXPECT_THAT(svg, Not(HasSubstr("<script")));
    EXPECT_THAT(svg, HasSubstr("&lt;x&gt;"));
}

TEST(SvgChart, metresAreEquallyLongOnMaps)
{
    Chart chart = chartOf({"path", {0, 4}, {0, 1}});
    chart.equalScales = true;
    std::smatch m;
    const std::string svg = svgOf(chart);
    ASSERT_TRUE(std::regex_search(
        svg, m, std::regex("points=\"([0-9.]+),([0-9.]+) ([0-9.]+),([0-9.]+) \"")));
    const double dx = std::stod(m[3]) - std::stod(m[1]);
    const double dy = std::stod(m[2]) - std::stod(m[4]);
    EXPECT_NEAR(dx, 4 * dy, 0.3);
}

TEST(SvgChart, levelsColourALineAndHaveABar)
{
    ChartSeries series{"path", {0, 1, 2, 3}, {0, 0, 0, 0}};
    series.level = {0, 0, 10, 10};
    Chart chart = chartOf(series);
    chart.levelLabel = "error [mm]";
    const std::string svg = svgOf(chart);
    EXPECT_EQ(count(svg, "<polyline class=\"level\""), 2u);
    EXPECT_THAT(svg, HasSubstr("#2676ca"));  // the least
    EXPECT_THAT(svg, HasSubstr("#d01c2e"));  // the most
    EXPECT_THAT(svg, HasSubstr("error [mm]"));
}

TEST(SvgChart, levelsAndBandsHaveHoles)
{
    const double hole = std::numeric_limits<double>::quiet_NaN();
    ChartSeries series{"path", {0, 1, 1, 2, 3}, {0, 0, hole, 0, 0}};
    series.level = {5, 5, hole, 5, 5};
    const std::string path = svgOf(chartOf(series));
    EXPECT_EQ(count(path, "<polyline class=\"level\""), 2u);
    EXPECT_THAT(path, Not(HasSubstr("nan")));
    series.level.clear();
    series.style = ChartSeries::Style::Band;
    series.yUpper = {1, 1, hole, 1, 1};
    const std::string band = svgOf(chartOf(series));
    EXPECT_EQ(count(band, "<polygon class=\"band"), 2u);
    EXPECT_THAT(band, Not(HasSubstr("nan")));
}

TEST(SvgChart, aFileOfItsOwnNeedsNoStyleSheet)
{
    const std::string file = svgFileOf(chartOf({"line", {0, 1}, {0, 1}}));
    EXPECT_THAT(file, testing::StartsWith("<?xml"));
    EXPECT_THAT(file, HasSubstr("<style>"));
    EXPECT_THAT(file, HasSubstr("stroke:#0072b2"));
    EXPECT_THAT(file, Not(HasSubstr("var(")));
}

TEST(Thinned, keepsExtremesGapsAndTheLast)
{
    std::vector<double> y;
    for (int k = 0; k < 100000; ++k)
    {
        y.push_back(std::sin(0.001 * k));
    }
    y[54321] = 77;
    y[12345] = -77;
    y[777] = y[54200] = std::numeric_limits<double>::quiet_NaN();
    y[54202] = 78;
    const std::vector<std::size_t> keep = thinned(y);
    EXPECT_LE(keep.size(), 3100u);
    for (const std::size_t wanted : {54321u, 12345u, 777u, 99999u, 0u, 54200u, 54202u})
    {
        EXPECT_THAT(keep, testing::Contains(wanted));
    }
    EXPECT_TRUE(std::is_sorted(keep.begin(), keep.end()));
}

TEST(XmlEscaped, whatXmlAllowsIsKeptAndTheRestIsMarked)
{
    const std::string mark = "\xef\xbf\xbd";
    EXPECT_EQ(xmlEscaped("a<b>&\"\t"), "a&lt;b&gt;&amp;&quot;\t");
    const std::string good = "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80 \xef\xbf\xbd";
    EXPECT_EQ(xmlEscaped(good), good);
    EXPECT_EQ(xmlEscaped(std::string("\0\x1b", 2)), mark + mark);
    EXPECT_EQ(xmlEscaped("\xe9!"), mark + "!");                         // Latin 1
    EXPECT_EQ(xmlEscaped("\xc3"), mark);                                // cut
    EXPECT_EQ(xmlEscaped("\x80"), mark);                                // no beginning
    EXPECT_EQ(xmlEscaped("\xc0\xaf"), mark + mark);                     // longer than need be
    EXPECT_EQ(xmlEscaped("\xed\xa0\x80"), mark + mark + mark);          // half a pair of UTF-16
    EXPECT_EQ(xmlEscaped("\xef\xbf\xbf"), mark + mark + mark);          // no character
    EXPECT_EQ(xmlEscaped("\xf4\x90\x80\x80").size(), 4 * mark.size());  // beyond the last one
}
