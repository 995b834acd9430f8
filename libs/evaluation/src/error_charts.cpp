// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/stamp_intervals.h>
#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/evaluation/units.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "chart_holes.h"

namespace pointplane
{
namespace
{
/** Bars of how many errors there are of each size, and the share of smaller ones on the right. */
Chart histogram(std::vector<double> errors, const std::string& what)
{
    std::sort(errors.begin(), errors.end());
    const auto n = static_cast<double>(errors.size());
    const auto bars = static_cast<std::size_t>(std::clamp(std::ceil(std::sqrt(n)), 5.0, 40.0));
    const double width = std::max(errors.back(), 1e-12) / static_cast<double>(bars);
    ChartSeries counts{what, {}, std::vector<double>(bars + 1, 0), ChartSeries::Style::Bars};
    ChartSeries share{"share of smaller errors", {0}, {0}, ChartSeries::Style::Steps, true};
    for (std::size_t k = 0; k <= bars; ++k)
    {
        counts.x.push_back(width * static_cast<double>(k));
    }
    for (std::size_t k = 0; k < errors.size(); ++k)
    {
        const auto bar = static_cast<std::size_t>(errors[k] / width);
        counts.y[std::min(bar, bars - 1)] += 1;
        share.x.push_back(errors[k]);
        share.y.push_back(100 * static_cast<double>(k + 1) / n);
    }
    Chart chart;
    chart.yLabel = what;
    chart.yRightLabel = "smaller [%]";
    chart.series = {counts, share};
    return chart;
}

/** Whether most pairs are of this length, to a tenth: there may be no frames at such a distance. */
bool areAbout(double seconds, const Trajectory& estimate, const RpeResult& result)
{
    const auto isAbout = [&](const RpePair& pair)
    {
        const double length = estimate.stamps[pair.j] - estimate.stamps[pair.i];
        return std::abs(length - seconds) <= 0.1 * seconds;
    };
    const auto count = std::count_if(result.pairs.begin(), result.pairs.end(), isAbout);
    return 2 * static_cast<std::size_t>(count) > result.pairs.size();
}
}  // namespace

Chart positionErrorHistogram(const AteResult& result)
{
    std::vector<double> errors;
    for (const AteError& error : result.errors)
    {
        errors.push_back(1000 * error.translation);
    }
    Chart chart = histogram(std::move(errors), "poses");
    chart.title = "Position errors (ATE) by size";
    chart.xLabel = "distance to the ground truth [mm]";
    return chart;
}

std::vector<Chart> errorHistograms(const RpeOptions& options, const RpeResult& result)
{
    std::vector<double> translations;
    std::vector<double> rotations;
    for (const RpePair& pair : result.pairs)
    {
        translations.push_back(1000 * pair.translation);
        rotations.push_back(kDegreesPerRadian * pair.rotation);
    }
    std::vector<Chart> charts{histogram(translations, "pairs"), histogram(rotations, "pairs")};
    charts[0].title = "Relative errors over " + nameOfDelta(options) + " by size: translation";
    charts[0].xLabel = "error [mm]";
    charts[1].title = "Relative errors over " + nameOfDelta(options) + " by size: rotation";
    charts[1].xLabel = "error [deg]";
    return charts;
}

namespace
{
Chart chartOverInterval(const std::string& what, const std::string& unit, const ChartSeries& series)
{
    Chart chart;
    chart.title = "Relative error over intervals: " + what;
    chart.xLabel = "interval [s]";
    chart.yLabel = "RMSE [" + unit + "]";
    chart.logX = chart.yFromZero = true;
    chart.series = {series};
    return chart;
}
}  // namespace

std::vector<Chart> errorOverInterval(
    const Trajectory& groundTruth, const Trajectory& estimate, const RpeOptions& options)
{
    ChartSeries translation{"RMSE", {}, {}};
    ChartSeries rotation{"RMSE", {}, {}};
    RpeOptions over = options;
    over.fixedDelta = true;
    over.unit = DeltaUnit::Seconds;
    for (const double seconds : {0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0})
    {
        if (seconds < medianInterval(estimate.stamps) || seconds > 0.5 * estimate.duration())
        {
            continue;  // pairs would be of a pose with itself, or there would be next to none
        }
        over.delta = seconds;
        try
        {
            const RpeResult result = relativePoseError(groundTruth, estimate, over);
            if (!areAbout(seconds, estimate, result))
            {
                throw std::runtime_error("pairs are of another length");
            }
            translation.x.push_back(seconds);
            translation.y.push_back(1000 * result.translation.rmse);
            rotation.x.push_back(seconds);
            rotation.y.push_back(kDegreesPerRadian * result.rotation.rmse);
        }
        catch (const std::runtime_error&)
        {
            interrupt(translation);  // nobody measured this length
            interrupt(rotation);
        }
    }
    const auto isMeasured = [](double y) { return std::isfinite(y); };
    if (std::count_if(translation.y.begin(), translation.y.end(), isMeasured) < 2)
    {
        return {};
    }
    return {
        chartOverInterval("translation", "mm", translation),
        chartOverInterval("rotation", "deg", rotation)};
}
}  // namespace pointplane
