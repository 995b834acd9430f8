// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_charts.h"

#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/units.h>

#include <limits>
#include <numeric>

namespace pointplane
{
namespace
{
/** The values as numbers; fewer where they are not all numbers. */
std::vector<double> numbersOf(const std::vector<std::string>& values)
{
    std::vector<double> numbers;
    for (const std::string& value : values)
    {
        if (const auto number = parseNumber<double>(value))
        {
            numbers.push_back(*number);
        }
    }
    return numbers;
}
}  // namespace

std::vector<Chart> sweepCharts(
    const std::string& parameter,
    const std::vector<std::string>& values,
    const std::vector<std::string>& sequences,
    const std::vector<LabScore>& scores,
    ValueAxis axis)
{
    std::vector<double> x = numbersOf(values);
    const bool named = axis == ValueAxis::Names || x.size() != values.size();
    if (named)
    {
        x.resize(values.size());
        std::iota(x.begin(), x.end(), 0);
    }
    std::vector<Chart> charts(2);
    charts[0].title = "Translation";
    charts[0].yLabel = "RPE RMSE [mm]";
    charts[1].title = "Rotation";
    charts[1].yLabel = "RPE RMSE [deg]";
    for (std::size_t c = 0; c < charts.size(); ++c)
    {
        charts[c].yFromZero = true;
        charts[c].xLabel = parameter;
        charts[c].logX = axis == ValueAxis::Log && !named;
        if (named)
        {
            charts[c].xNames = values;
        }
        for (std::size_t s = 0; s < sequences.size(); ++s)
        {
            ChartSeries series;
            series.name = sequences[s];
            series.x = x;
            for (std::size_t v = 0; v < values.size(); ++v)
            {
                const auto& rpe = scores[s * values.size() + v].rpe;
                series.y.push_back(
                    !rpe     ? std::numeric_limits<double>::quiet_NaN()
                    : c == 0 ? 1000 * rpe->translation.rmse
                             : kDegreesPerRadian * rpe->rotation.rmse);
            }
            charts[c].series.push_back(std::move(series));
        }
    }
    return charts;
}
}  // namespace pointplane
