// SPDX-License-Identifier: BSD-3-Clause
#include "chart_holes.h"

#include <pointplane/evaluation/stamp_intervals.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pointplane
{
void interrupt(ChartSeries& series)
{
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    if (series.x.empty() || std::isnan(series.y.back()))
    {
        return;
    }
    series.x.push_back(series.x.back());
    series.y.push_back(kNaN);
    for (std::vector<double>* values : {&series.yUpper, &series.level})
    {
        if (!values->empty())
        {
            values->push_back(kNaN);
        }
    }
}

ChartHoles::ChartHoles(const Trajectory& trajectory)
    : trajectory_(trajectory),
      holes_(holesBefore(trajectory)),
      longestStep_(longestStep(trajectory.stamps))
{
}

bool ChartHoles::isBetween(std::size_t from, std::size_t to) const
{
    const auto begin = holes_.begin() + static_cast<std::ptrdiff_t>(from) + 1;
    const auto end = holes_.begin() + static_cast<std::ptrdiff_t>(to) + 1;
    return trajectory_.stamps[to] - trajectory_.stamps[from] > longestStep_ ||
           (from < to && std::find(begin, end, true) != end);
}
}  // namespace pointplane
