// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/chi_square.h>
#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/evaluation/units.h>

#include <cmath>

#include "chart_holes.h"

namespace pointplane
{
namespace
{
constexpr const char* kGrey = "muted";
constexpr const char* kOrange = "accent";
constexpr const char* kRed = "alarm";

/** Horizontal lines over [0, end], as one series. */
ChartSeries levels(
    const std::string& name, const std::vector<double>& values, double end, const char* colour)
{
    ChartSeries series{name, {}, {}, ChartSeries::Style::Dashed, false, colour};
    for (const double value : values)
    {
        series.x.insert(series.x.end(), {0, end});
        series.y.insert(series.y.end(), {value, value});
        interrupt(series);
    }
    return series;
}
}  // namespace

std::vector<Chart> relativeErrorCharts(
    const Trajectory& estimate, const RpeOptions& options, const RpeResult& result)
{
    const ChartHoles holes(estimate);
    std::vector<Chart> charts;
    for (const bool translation : {true, false})
    {
        Chart chart;
        chart.title = std::string("Relative error over ") + nameOfDelta(options) +
                      (translation ? ": translation" : ": rotation");
        chart.xLabel = "time of the pair's start [s]";
        chart.yLabel = translation ? "error [mm]" : "error [deg]";
        ChartSeries series;
        series.name = "error";
        double end = 0;
        std::size_t before = 0;
        for (const RpePair& pair : result.pairs)
        {
            if (holes.isBetween(before, pair.i))
            {
                interrupt(series);
            }
            before = pair.i;
            end = estimate.stamps[pair.i] - estimate.stamps.front();
            series.x.push_back(end);
            series.y.push_back(
                translation ? 1000 * pair.translation : kDegreesPerRadian * pair.rotation);
        }
        chart.series.push_back(std::move(series));
        chart.series.push_back(levels(
            "RMSE",
            {translation ? 1000 * result.translation.rmse
                         : kDegreesPerRadian * result.rotation.rmse},
            end,
            kRed));
        chart.yFromZero = true;
        charts.push_back(std::move(chart));
    }
    return charts;
}

Chart positionErrorChart(const Trajectory& estimate, const AteResult& result)
{
    Chart chart;
    chart.title = "Position error (ATE)";
    chart.xLabel = "time [s]";
    chart.yLabel = "distance to the ground truth [mm]";
    ChartSeries series;
    series.name = "position error";
    const ChartHoles holes(estimate);
    std::size_t before = 0;
    for (const AteError& error : result.errors)
    {
        if (holes.isBetween(before, error.estimate))
        {
            interrupt(series);
        }
        before = error.estimate;
        series.x.push_back(estimate.stamps[error.estimate] - estimate.stamps.front());
        series.y.push_back(1000 * error.translation);
    }
    chart.series.push_back(std::move(series));
    chart.yFromZero = true;
    return chart;
}

Chart neesChart(
    const Trajectory& estimate,
    const std::vector<NeesIncrement>& increments,
    const NeesResult& result)
{
    Chart chart;
    chart.title = result.interval.sinceStart ? "NEES of the poses since the first one"
                                             : "NEES of increments of " + describe(result.interval);
    chart.xLabel = "time of the increment's end [s]";
    chart.yLabel = "NEES per degree of freedom";
    chart.logY = true;
    ChartSeries series;
    series.name = "NEES";
    series.style = ChartSeries::Style::Points;
    for (const NeesIncrement& increment : increments)
    {
        series.x.push_back(estimate.stamps[increment.j] - estimate.stamps.front());
        series.y.push_back(increment.nees / 6);
    }
    const double end = series.x.empty() ? 1 : series.x.back();
    chart.series.push_back(std::move(series));
    chart.series.push_back(levels(
        "95 % of dots",
        {chiSquareQuantile(0.025, 6) / 6, chiSquareQuantile(0.975, 6) / 6},
        end,
        kGrey));
    chart.series.push_back(levels("mean", {result.joint.nees}, end, kRed));
    chart.series.push_back(
        levels("95 % range of the mean", {result.joint.lower, result.joint.upper}, end, kOrange));
    return chart;
}

std::vector<Chart> errorAgainstSigmaCharts(
    const Trajectory& estimate,
    const std::vector<NeesIncrement>& increments,
    const NeesInterval& interval)
{
    static const char* const kNames[] = {"x", "y", "z", "rx", "ry", "rz"};
    std::vector<Chart> charts;
    for (const bool translation : {true, false})
    {
        Chart chart;
        chart.title = std::string(translation ? "Translation" : "Rotation") + " error of " +
                      (interval.sinceStart ? "poses" : "increments of " + describe(interval)) +
                      " in standard deviations";
        chart.xLabel = "time of the increment's end [s]";
        chart.yLabel = "error / sigma";
        double end = 1;
        for (int k = translation ? 0 : 3; k < (translation ? 3 : 6); ++k)
        {
            ChartSeries series;
            series.name = kNames[k];
            series.style = ChartSeries::Style::Points;
            for (const NeesIncrement& increment : increments)
            {
                series.x.push_back(estimate.stamps[increment.j] - estimate.stamps.front());
                series.y.push_back(increment.error[k] / std::sqrt(increment.cov(k, k)));
            }
            end = series.x.empty() ? end : series.x.back();
            chart.series.push_back(std::move(series));
        }
        chart.series.push_back(levels("3 sigma", {-3, 3}, end, kGrey));
        charts.push_back(std::move(chart));
    }
    return charts;
}
}  // namespace pointplane
