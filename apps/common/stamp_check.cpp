// SPDX-License-Identifier: BSD-3-Clause
#include "stamp_check.h"

#include <pointplane/core/number_text.h>
#include <pointplane/core/quantile.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace pointplane
{
namespace
{
constexpr std::size_t kLeastIntervals = 10;
/** Rounding or jitter of less than this part of an interval is no matter. */
constexpr double kTolerated = 0.1;
/** Steps that stamps are rounded to [s]. */
constexpr double kRoundings[] = {1, 0.1, 0.01};
constexpr double kEpsilon = 1e-5;

constexpr char kEvenStamps[] = " (pointplane-convert tum and folder have --even-stamps)";
constexpr char kConsequence[] = "; velocities from them err as much, which covariances do not tell";

[[nodiscard]] bool areMultiples(const std::vector<double>& stamps, double step)
{
    return std::all_of(
        stamps.begin(),
        stamps.end(),
        [&](double t) { return std::abs(t / step - std::round(t / step)) * step < kEpsilon; });
}

[[nodiscard]] std::string problemOfOrder(const std::vector<double>& intervals)
{
    const auto numBack = std::count_if(
        intervals.begin(), intervals.end(), [](double interval) { return interval < 0; });
    const auto numRepeated = std::count(intervals.begin(), intervals.end(), 0.0);
    std::ostringstream out;
    if (numBack > 0)
    {
        out << numBack << " of them " << (numBack == 1 ? "is" : "are") << " before the one before";
    }
    else if (numRepeated > 0)
    {
        out << numRepeated << " of them " << (numRepeated == 1 ? "repeats" : "repeat")
            << " the one before: odometry cannot use such frames" << kEvenStamps;
    }
    return out.str();
}

/** Frames 33 s, or 33 microseconds, apart are rather 33 ms apart. */
[[nodiscard]] std::string problemOfUnit(double median)
{
    // Of recordings [s]; numbers of frames are as far apart.
    constexpr double kShortest = 0.9e-3, kLongest = 1;
    std::ostringstream out;
    if (median >= kLongest || median < kShortest)
    {
        out << "a frame every " << std::setprecision(3) << median
            << " s; are they in seconds? Else the odometry takes the camera for "
            << (median >= kLongest ? "slow" : "fast") << ", and its covariances are wrong";
    }
    return out.str();
}

[[nodiscard]] std::string problemOfRounding(
    const std::vector<double>& stamps, const std::vector<double>& intervals, double median)
{
    // A camera of 10 or 20 Hz has true stamps like that.
    const bool isEven = quantile(intervals, 0.9) - quantile(intervals, 0.1) < kEpsilon;
    std::ostringstream out;
    for (const double step : kRoundings)
    {
        if (step > kTolerated * median && !isEven && areMultiples(stamps, step))
        {
            out << "rounded to " << step << " s, " << std::lround(100 * step / median)
                << " % of the time between frames" << kConsequence << kEvenStamps;
            break;
        }
    }
    return out.str();
}

/** Of intervals that should be whole numbers of frames [s]. */
[[nodiscard]] double jitterAbout(const std::vector<double>& intervals, double perFrame)
{
    std::vector<double> deviations;
    for (const double interval : intervals)
    {
        const double frames = std::max(1.0, std::round(interval / perFrame));
        deviations.push_back(std::abs(interval - frames * perFrame));
    }
    return 1.4826 * quantile(deviations, 0.5);
}

[[nodiscard]] std::string problemOfJitter(const std::vector<double>& intervals, double median)
{
    // A slow computer leaves frames out: the median may be several of them.
    constexpr int kMostFrames = 5;
    for (int frames = 1; frames <= kMostFrames; ++frames)
    {
        const double perFrame = median / frames;
        if (jitterAbout(intervals, perFrame) <= kTolerated * perFrame)
        {
            return "";
        }
    }
    std::ostringstream out;
    out << "they jitter by " << std::lround(1e3 * jitterAbout(intervals, median))
        << " ms about a frame every " << std::lround(1e3 * median) << " ms, like a host's"
        << kConsequence << kEvenStamps;
    return out.str();
}
}  // namespace

std::string problemOfStamps(const std::vector<double>& stamps)
{
    std::vector<double> intervals;
    for (std::size_t i = 1; i < stamps.size(); ++i)
    {
        intervals.push_back(stamps[i] - stamps[i - 1]);
    }
    if (const std::string problem = problemOfOrder(intervals);
        intervals.empty() || !problem.empty())
    {
        return problem;
    }
    const double median = quantile(intervals, 0.5);
    if (const std::string problem = problemOfUnit(median);
        intervals.size() < kLeastIntervals || !problem.empty())
    {
        return problem;
    }
    const std::string rounding = problemOfRounding(stamps, intervals, median);
    return rounding.empty() ? problemOfJitter(intervals, median) : rounding;
}

void requireTimes(const std::vector<double>& stamps, const std::string& name)
{
    const auto isFirst = [&](double stamp) { return stamp == stamps.front(); };
    if (stamps.size() > 1 && std::all_of(stamps.begin(), stamps.end(), isFirst))
    {
        throw InputError(
            name + ": all its images have the stamp " + numberText(stamps.front(), 3) +
            " s; the program that recorded them must tell when they were taken");
    }
}
}  // namespace pointplane
