// SPDX-License-Identifier: BSD-3-Clause
#include "even_stamps.h"

#include <pointplane/core/quantile.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <sstream>
#include <string>
#include <utility>

namespace pointplane
{
namespace
{
/** Stamps as far away [s] still tell of the camera's clock: longer averages more jitter, shorter
 * follows a rate that changes, as with the exposure. */
constexpr double kReach = 0.5;

// Parts of an interval: what stamps may be off by (standard deviation), so that frames can be
// counted, and what a single one may.
constexpr double kMostJitter = 0.25, kFarthest = 1;

/** The same, over the step that stamps are rounded to, if it is so coarse that they repeat. */
constexpr double kReachOverRounding = 10;

/** Intervals on either side that tell the usual one: a rate may change. */
constexpr std::ptrdiff_t kAround = 15;

/** Time between two frames, none of which is missing, around one of the intervals. */
[[nodiscard]] double intervalAround(const std::vector<double>& intervals, std::size_t at)
{
    const auto i = static_cast<std::ptrdiff_t>(at);
    const auto size = static_cast<std::ptrdiff_t>(intervals.size());
    const std::vector<double> around(
        intervals.begin() + std::max<std::ptrdiff_t>(i - kAround, 0),
        intervals.begin() + std::min(i + kAround + 1, size));
    const double typical = median(around);
    double sum = 0, count = 0;
    for (const double interval : around)
    {
        if (std::abs(interval - typical) < 0.5 * typical)
        {
            sum += interval;
            ++count;
        }
    }
    return count > 0 ? sum / count : typical;
}

/** A frame: its number, counted with the missing ones, and its stamp. */
struct Frame
{
    int piece{0};  //!< between pieces, nothing tells how many frames are missing
    double number{0}, stamp{0}, interval{0};
};

[[nodiscard]] std::vector<double> intervalsOf(const std::vector<double>& stamps)
{
    std::vector<double> out;
    for (std::size_t i = 1; i < stamps.size(); ++i)
    {
        out.push_back(stamps[i] - stamps[i - 1]);
        if (!(out.back() >= 0))
        {
            throw InputError("the stamps go back, so they cannot be evened out");
        }
    }
    return out;
}

/** The step that stamps are rounded to, if they repeat because of that, else 0 [s]. */
[[nodiscard]] double roundingOf(const std::vector<double>& intervals)
{
    double least = HUGE_VAL;
    for (const double interval : intervals)
    {
        least = interval > 0 ? std::min(least, interval) : least;
    }
    const bool repeat = std::find(intervals.begin(), intervals.end(), 0.0) != intervals.end();
    if (repeat && std::isinf(least))
    {
        throw InputError("all stamps are the same, so they cannot be evened out");
    }
    return repeat ? least : 0;
}

/** The same for stamps that repeat. Nothing tells which frames are missing, unless a whole step is.
 * \throws InputError if most stamps are farther apart than such a step */
[[nodiscard]] std::vector<Frame> numberedInOrder(
    const std::vector<double>& stamps, const std::vector<double>& intervals, double rounding)
{
    double sum = 0, count = 0;
    for (const double interval : intervals)
    {
        if (interval < 1.5 * rounding)
        {
            sum += interval;
            ++count;
        }
    }
    if (2 * count < static_cast<double>(intervals.size()))
    {
        throw InputError("stamps repeat, and not by rounding, so they cannot be evened out");
    }
    std::vector<Frame> out{{0, 0, stamps.front(), sum / count}};
    for (std::size_t i = 0; i < intervals.size(); ++i)
    {
        const bool isPause = intervals[i] > 1.5 * rounding;
        const Frame& last = out.back();
        out.push_back(
            {last.piece + (isPause ? 1 : 0), last.number + 1, stamps[i + 1], last.interval});
    }
    return out;
}

/** Numbers of frames that follow each other. \throws InputError */
[[nodiscard]] std::vector<Frame> numbered(
    const std::vector<double>& stamps, const std::vector<double>& intervals)
{
    std::vector<Frame> out{{0, 0, stamps.front(), intervalAround(intervals, 0)}};
    std::vector<double> deviations;  // over the interval
    for (std::size_t i = 0; i < intervals.size(); ++i)
    {
        const double interval = intervalAround(intervals, i), parts = intervals[i] / interval;
        const double step = std::max(1.0, std::round(parts));
        const double deviation = std::abs(parts - step);
        const bool isPause = intervals[i] > kReach || (step > 1 && deviation > kMostJitter);
        if (!isPause)
        {
            deviations.push_back(deviation);
        }
        const Frame& last = out.back();
        out.push_back(
            {last.piece + (isPause ? 1 : 0), last.number + step, stamps[i + 1], interval});
    }
    if (!deviations.empty() && 1.4826 * median(deviations) > kMostJitter)
    {
        throw InputError("the stamps are not those of a steady rate, so they cannot be evened out");
    }
    return out;
}

/** On the line through the frames around it: iterated Cauchy weights, as a host's delays have a
 * long tail. */
[[nodiscard]] double onLine(const std::vector<Frame>& around, const Frame& frame)
{
    std::vector<double> weights(around.size(), 1), residuals(around.size());
    double offset = 0;
    for (int iteration = 0; iteration < 10; ++iteration)
    {
        double w = 0, x = 0, y = 0, xx = 0, xy = 0;
        for (std::size_t i = 0; i < around.size(); ++i)
        {
            const double n = around[i].number - frame.number, t = around[i].stamp - frame.stamp;
            w += weights[i];
            x += weights[i] * n;
            y += weights[i] * t;
            xx += weights[i] * n * n;
            xy += weights[i] * n * t;
        }
        const double determinant = w * xx - x * x;
        const double slope = determinant > 0 ? (w * xy - x * y) / determinant : 0;
        offset = (y - slope * x) / w;
        for (std::size_t i = 0; i < around.size(); ++i)
        {
            const double n = around[i].number - frame.number;
            residuals[i] = std::abs(around[i].stamp - frame.stamp - offset - slope * n);
        }
        const double scale = 2 * 1.4826 * median(residuals) + 1e-6;
        for (std::size_t i = 0; i < around.size(); ++i)
        {
            weights[i] = 1 / (1 + (residuals[i] / scale) * (residuals[i] / scale));
        }
    }
    return frame.stamp + offset;
}

/** How far stamps were moved, one line for people. */
[[nodiscard]] std::string describeEvening(
    const std::vector<double>& before, const std::vector<double>& after)
{
    double sumOfSquares = 0, most = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
    {
        const double moved = std::abs(after[i] - before[i]);
        sumOfSquares += moved * moved;
        most = std::max(most, moved);
    }
    const double rms = std::sqrt(sumOfSquares / std::max(1.0, static_cast<double>(before.size())));
    std::ostringstream out;
    out << std::fixed << std::setprecision(1) << "stamps: evened out, moved by " << 1e3 * rms
        << " ms (rms), " << 1e3 * most << " ms at most";
    return out.str();
}
}  // namespace

std::vector<double> evenStamps(const std::vector<double>& stamps)
{
    if (stamps.size() < 3)
    {
        return stamps;
    }
    const std::vector<double> intervals = intervalsOf(stamps);
    const double rounding = roundingOf(intervals);
    const double reach = std::max(kReach, kReachOverRounding * rounding);
    const std::vector<Frame> frames =
        rounding > 0 ? numberedInOrder(stamps, intervals, rounding) : numbered(stamps, intervals);
    std::vector<double> out;
    std::size_t begin = 0, end = 0;
    for (const Frame& frame : frames)
    {
        while (frame.stamp - frames[begin].stamp > reach || frames[begin].piece < frame.piece)
        {
            ++begin;
        }
        while (end < frames.size() && frames[end].stamp - frame.stamp <= reach &&
               frames[end].piece == frame.piece)
        {
            ++end;
        }
        const auto first = frames.begin();
        out.push_back(onLine(
            {first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end)},
            frame));
        if (std::abs(out.back() - frame.stamp) > kFarthest * std::max(frame.interval, rounding))
        {
            throw InputError(
                "evened out, a stamp would move by " +
                std::to_string(std::lround(1e3 * std::abs(out.back() - frame.stamp))) +
                " ms: the rate is not steady");
        }
    }
    for (std::size_t i = 1; i < out.size(); ++i)
    {
        out[i] = std::max(out[i], std::nextafter(out[i - 1], HUGE_VAL));
    }
    return out;
}

EvenedStamps evenOut(const std::vector<double>& stamps, const std::string& name)
{
    try
    {
        std::vector<double> even = evenStamps(stamps);
        std::string note = describeEvening(stamps, even);
        return {std::move(even), std::move(note)};
    }
    catch (const InputError& e)
    {
        throw InputError(name + ": " + e.what());
    }
}
}  // namespace pointplane
