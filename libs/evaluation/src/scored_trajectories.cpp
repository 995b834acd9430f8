// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/counted.h>
#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/scored_trajectories.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "short_number.h"

namespace pointplane
{
namespace
{
std::string timeRange(const char* role, const Trajectory& trajectory, double offset)
{
    return std::string(role) + " '" + trajectory.name + "' [" +
           numberText(trajectory.stamps.front() + offset, 3) + ", " +
           numberText(trajectory.stamps.back() + offset, 3) + "] s";
}

/** What two trajectories that do not overlap may be, as the end of a message. */
std::string whyApart(const Trajectory& groundTruth, const Trajectory& estimate)
{
    constexpr double kAlike = 0.01;  // stamps since 1970 differ by less within half a year
    const std::pair<double, const char*> units[] = {
        {1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}};
    for (const auto& [perSecond, unit] : units)
    {
        for (const auto& [fine, coarse] :
             {std::pair(&groundTruth, &estimate), std::pair(&estimate, &groundTruth)})
        {
            const double seconds = fine->stamps.front() / perSecond;
            if (std::abs(seconds - coarse->stamps.front()) <
                kAlike * std::abs(coarse->stamps.front()))
            {
                return "; stamps of '" + fine->name + "' look like " + unit +
                       ": write them in seconds";
            }
        }
    }
    return "; are these files of the same sequence? (--offset shifts the estimate)";
}

/** Of a program that did not ask makeTrajectory(). */
void checkWhole(const Trajectory& t)
{
    const auto requireSize = [&t](std::size_t size, const char* what)
    {
        POINTPLANE_CHECK(
            size == t.size(),
            "'" << t.name << "' has " << t.size() << " stamps, but " << size << " " << what);
    };
    requireSize(t.poses.size(), "poses");
    requireSize(t.covs.empty() ? t.size() : t.covs.size(), "covariances");
    requireSize(t.sinceCovs.empty() ? t.size() : t.sinceCovs.size(), "lists of covariances");
    requireSize(t.numbers.empty() ? t.size() : t.numbers.size(), "numbers");
    requireSize(t.status.empty() ? t.size() : t.status.size(), "states");
    const auto isNotBefore = [](double a, double b) { return !(a < b); };
    POINTPLANE_CHECK(
        std::adjacent_find(t.stamps.begin(), t.stamps.end(), isNotBefore) == t.stamps.end(),
        "'" << t.name << "': stamps are not in order; makeTrajectory() sorts them");
}
}  // namespace

void checkOverlap(const Trajectory& groundTruth, const Trajectory& estimate, double offset)
{
    for (const Trajectory* t : {&groundTruth, &estimate})
    {
        checkWhole(*t);
        if (t->size() < 2)
        {
            throw std::runtime_error(
                "'" + t->name + "' has " + counted(t->size(), "usable pose") +
                "; at least two are needed");
        }
    }
    if (!(estimate.stamps.back() + offset >= groundTruth.stamps.front() &&
          estimate.stamps.front() + offset <= groundTruth.stamps.back()))
    {
        throw std::runtime_error(
            "the trajectories do not overlap in time: " +
            timeRange("ground truth", groundTruth, 0) + ", " +
            timeRange("estimate", estimate, offset) + whyApart(groundTruth, estimate));
    }
}

std::string describeChanges(double offset, double scale)
{
    std::ostringstream out = numberStream();
    if (offset != 0)
    {
        out << " stamps " << std::showpos << offset << std::noshowpos << " s";
    }
    if (scale != 1)
    {
        out << (offset != 0 ? " and" : "") << " translations times " << scale;
    }
    return out.str().empty() ? "" : ", estimate's" + out.str();
}

void checkPositions(const Trajectory& trajectory, double scale)
{
    constexpr double kFarthest = 1e8;
    for (std::size_t i = 0; i < trajectory.size(); ++i)
    {
        const double distance = scale * trajectory.poses[i].translation().lpNorm<Eigen::Infinity>();
        if (!(distance <= kFarthest))
        {
            throw std::runtime_error(
                trajectory.name + ": the position at " + numberText(trajectory.stamps[i], 6) +
                " s" + (scale == 1 ? "" : " times " + numberText(scale, 3)) + " is " +
                shortNumber(distance) + " m away from the origin, beyond " +
                shortNumber(kFarthest) + " m, where digits are lost; are positions in metres?");
        }
    }
}
}  // namespace pointplane
