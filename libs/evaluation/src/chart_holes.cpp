// SPDX-License-Identifier: BSD-3-Clause
#include "chart_holes.h"

#include <limits>

namespace pointplane
{
void interrupt(ChartSeries& series)
{
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    if (series.x.empty())
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

bool isHoleBetween(const std::vector<bool>& holes, std::size_t from, std::size_t to)
{
    for (std::size_t k = from + 1; k <= to; ++k)
    {
        if (holes[k])
        {
            return true;
        }
    }
    return false;
}
}  // namespace pointplane
