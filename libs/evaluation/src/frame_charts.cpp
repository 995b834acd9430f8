// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/trajectory_charts.h>

#include <string>
#include <utility>

namespace pointplane
{
namespace
{
enum class Axis
{
    Left,
    Right
};

/** A column of the table, by its name there and in the chart. */
struct DrawnColumn
{
    std::string column, name;
    Axis axis{Axis::Left};
    ChartSeries::Style style{ChartSeries::Style::Line};
};

/** Adds the chart, with those columns that are there, unless none is. */
void addColumns(
    Chart chart,
    const std::vector<DrawnColumn>& columns,
    const FrameTable& table,
    double start,
    std::vector<Chart>& charts)
{
    for (const DrawnColumn& drawn : columns)
    {
        if (table.has(drawn.column))
        {
            ChartSeries& series = chart.series.emplace_back();
            series.name = drawn.name;
            series.rightAxis = drawn.axis == Axis::Right;
            series.style = drawn.style;
            series.y = table.column(drawn.column);
            for (const double stamp : table.stamps())
            {
                series.x.push_back(stamp - start);
            }
        }
    }
    if (!chart.series.empty())
    {
        charts.push_back(std::move(chart));
    }
}

Chart statusChart(const FrameTable& table, double start)
{
    Chart chart;
    chart.title = "Tracking status";
    chart.xLabel = "time [s]";
    chart.yLabel = "";
    const std::vector<double> directions = table.column("observableDirections");
    chart.yNames = {"lost", "predicted", "tracked"};
    if (!directions.empty())
    {
        chart.yNames.insert(chart.yNames.end() - 1, "in part");
    }
    const double best = static_cast<double>(chart.yNames.size() - 1);
    ChartSeries series;
    series.name = "status";
    series.style = ChartSeries::Style::Steps;
    for (std::size_t k = 0; k < table.size(); ++k)
    {
        const std::string& status = table.status()[k];
        series.x.push_back(table.stamps()[k] - start);
        const bool isInPart = status == "tracked" && !directions.empty() && directions[k] < 6;
        series.y.push_back(
            status == "lost"        ? 0
            : status == "predicted" ? 1
                                    : best - (isInPart ? 1 : 0));
    }
    chart.series.push_back(std::move(series));
    return chart;
}
}  // namespace

std::vector<Chart> frameCharts(const FrameTable& table, double start)
{
    std::vector<Chart> charts;
    if (table.size() == 0)
    {
        return charts;
    }
    Chart features;
    features.title = "Points and planes per frame";
    features.xLabel = "time [s]";
    features.yLabel = "points";
    features.yRightLabel = "planes";
    addColumns(
        features,
        {{"numPoints", "points"},
         {"numPointPairs", "point pairs"},
         {"numPointInliers", "inliers", Axis::Left, ChartSeries::Style::Dashed},
         {"numPlanes", "planes", Axis::Right},
         {"numPlanePairs", "plane pairs", Axis::Right, ChartSeries::Style::Dashed}},
        table,
        start,
        charts);
    if (!table.status().empty())
    {
        charts.push_back(statusChart(table, start));
    }
    Chart times;
    times.title = "Time per stage";
    times.xLabel = "time [s]";
    times.yLabel = "ms per frame";
    addColumns(
        times,
        {{"msTotal", "total"},
         {"msPoints", "points"},
         {"msPlanes", "planes"},
         {"msMatching", "matching"},
         {"msPose", "pose"}},
        table,
        start,
        charts);
    return charts;
}
}  // namespace pointplane
