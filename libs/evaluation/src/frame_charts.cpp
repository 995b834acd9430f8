// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/trajectory_charts.h>

#include <string>
#include <utility>

namespace pointplane
{
namespace
{
ChartSeries columnSeries(
    const FrameTable& table,
    double start,
    const std::string& column,
    const std::string& name,
    bool rightAxis)
{
    ChartSeries series;
    series.name = name;
    series.rightAxis = rightAxis;
    series.y = table.column(column);
    for (const double stamp : table.stamps())
    {
        series.x.push_back(stamp - start);
    }
    return series;
}

/** Adds a chart of those columns that are there. */
void addColumns(
    std::vector<Chart>& charts,
    Chart chart,
    const FrameTable& table,
    double start,
    const std::vector<std::pair<std::string, std::string>>& left,
    const std::vector<std::pair<std::string, std::string>>& right)
{
    for (const auto& [column, name] : left)
    {
        if (table.has(column))
        {
            chart.series.push_back(columnSeries(table, start, column, name, false));
        }
    }
    for (const auto& [column, name] : right)
    {
        if (table.has(column))
        {
            chart.series.push_back(columnSeries(table, start, column, name, true));
        }
    }
    if (!chart.series.empty())
    {
        charts.push_back(std::move(chart));
    }
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
        charts,
        features,
        table,
        start,
        {{"numPoints", "points"}, {"numPointPairs", "point pairs"}, {"numPointInliers", "inliers"}},
        {{"numPlanes", "planes"}, {"numPlanePairs", "plane pairs"}});

    if (!table.status().empty())
    {
        Chart status;
        status.title = "Tracking status";
        status.xLabel = "time [s]";
        status.yLabel = "";
        status.yNames = {"lost", "predicted", "tracked"};
        ChartSeries series;
        series.name = "status";
        series.style = ChartSeries::Style::Steps;
        for (std::size_t k = 0; k < table.size(); ++k)
        {
            const std::string& s = table.status()[k];
            series.x.push_back(table.stamps()[k] - start);
            series.y.push_back(s == "lost" ? 0 : s == "predicted" ? 1 : 2);
        }
        status.series.push_back(std::move(series));
        charts.push_back(std::move(status));
    }
    Chart times;
    times.title = "Time per stage";
    times.xLabel = "time [s]";
    times.yLabel = "ms per frame";
    addColumns(
        charts,
        times,
        table,
        start,
        {{"msTotal", "total"},
         {"msPoints", "points"},
         {"msPlanes", "planes"},
         {"msMatching", "matching"},
         {"msPose", "pose"}},
        {});
    return charts;
}
}  // namespace pointplane
