// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/counted.h>
#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/nees_interval.h>

#include <cmath>
#include <stdexcept>

#include "short_number.h"

namespace pointplane
{
NeesInterval neesIntervalFromName(const std::string& name)
{
    NeesInterval interval;
    if (name == "start")
    {
        interval.sinceStart = true;
        return interval;
    }
    const char unit = name.empty() ? ' ' : name.back();
    interval.unit = unit == 's' ? DeltaUnit::Seconds : DeltaUnit::Frames;
    interval.delta = parseFinite(name.substr(0, name.size() - 1)).value_or(0);
    constexpr double kMostFrames = 1e9;  // a year of them
    const bool isNumber =
        interval.delta == std::floor(interval.delta) && interval.delta <= kMostFrames;
    if (!(interval.delta > 0) || (unit != 's' && unit != 'f') || (unit == 'f' && !isNumber))
    {
        throw std::invalid_argument(
            "'" + name + "' is not an interval; frames or seconds, e.g. 1f, 10f or 1s, or start");
    }
    return interval;
}

std::string nameOf(const NeesInterval& interval)
{
    if (interval.sinceStart)
    {
        return "start";
    }
    return shortNumber(interval.delta) + nameOf(interval.unit);
}

std::string describe(const NeesInterval& interval)
{
    return interval.sinceStart ? "poses since the first"
           : interval.unit == DeltaUnit::Frames
               ? counted(static_cast<std::size_t>(interval.delta), "frame")
               : shortNumber(interval.delta) + " s";
}
}  // namespace pointplane
