// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/number_text.h>
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/Statistics.h>
#include <pointplane/evaluation/Trajectory.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace pointplane
{
namespace
{
/** Running sum of measure(T_next_previous), starting at 0. */
template <class Measure>
std::vector<double> accumulate(const Trajectory& trajectory, Measure measure)
{
    std::vector<double> out;
    for (std::size_t i = 0; i < trajectory.size(); ++i)
    {
        out.push_back(
            i == 0 ? 0
                   : out.back() + measure(trajectory.poses[i].inverse() * trajectory.poses[i - 1]));
    }
    return out;
}

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

/** Moves poses that are no numbers out of the list. \return their stamps */
std::vector<double> removeNotFinite(std::vector<StampedPose>& poses)
{
    const auto bad = std::stable_partition(
        poses.begin(), poses.end(), [](const auto& p) { return p.pose.matrix().allFinite(); });
    std::vector<double> stamps;
    std::transform(
        bad, poses.end(), std::back_inserter(stamps), [](const auto& p) { return p.stamp; });
    poses.erase(bad, poses.end());
    return stamps;
}

void warnOfNanoseconds(Trajectory& trajectory)
{
    constexpr double kLongest = 1000;
    // The mean is at least about half of the median, which takes longer to compute.
    const double mean = trajectory.duration() / static_cast<double>(trajectory.size() + 1);
    if (std::isfinite(mean) && mean > 0.2 * kLongest &&
        medianInterval(trajectory.stamps) > kLongest)
    {
        trajectory.warnings.push_back(
            trajectory.name + ": poses are " + numberText(medianInterval(trajectory.stamps), 0) +
            " s apart; are stamps in nanoseconds? They must be in seconds");
    }
}
/** Numbers poses in the order of their file, and removes those of lost frames whose stamp is not
 * after that of the pose before: where the camera was at that time, they do not tell.
 * \return how many */
std::size_t removeLate(std::vector<StampedPose>& poses)
{
    std::vector<StampedPose> kept;
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
        poses[i].number = i;
        if (kept.empty() || poses[i].status != FrameStatus::Lost ||
            poses[i].stamp > kept.back().stamp)
        {
            kept.push_back(std::move(poses[i]));
        }
    }
    const std::size_t removed = poses.size() - kept.size();
    poses = std::move(kept);
    return removed;
}

/** Of poses in the order of their file. \return what to tell the user, or empty */
std::string stampsThatGoBack(const std::string& name, const std::vector<StampedPose>& poses)
{
    std::size_t num = 0, first = 0;
    for (std::size_t i = 1; i < poses.size(); ++i)
    {
        if (poses[i].stamp < poses[i - 1].stamp && num++ == 0)
        {
            first = i;
        }
    }
    return num == 0 ? ""
                    : name + ": " + std::to_string(num) +
                          " stamp(s) go back in time, the first one from " +
                          numberText(poses[first - 1].stamp, 6) + " to " +
                          numberText(poses[first].stamp, 6) +
                          " s: poses were sorted by time; score two recordings apart";
}

}  // namespace

Trajectory makeTrajectory(std::string name, std::vector<StampedPose> poses)
{
    Trajectory out;
    out.lostWithoutTime = removeLate(poses);
    const std::string back = stampsThatGoBack(name, poses);
    std::stable_sort(
        poses.begin(),
        poses.end(),
        [](const StampedPose& a, const StampedPose& b)
        {
            const auto key = [](const StampedPose& p)
            { return std::make_pair(p.stamp, p.status != FrameStatus::Lost); };
            return key(a) < key(b);
        });

    out.name = std::move(name);
    if (out.lostWithoutTime > 0)
    {
        out.warnings.push_back(
            out.name + ": " + std::to_string(out.lostWithoutTime) +
            " lost frame(s) with a stamp that is not after the one before have no pose");
    }
    if (!back.empty())
    {
        out.warnings.push_back(back);
    }
    out.lostStamps = removeNotFinite(poses);
    if (!out.lostStamps.empty())
    {
        out.warnings.push_back(
            out.name + ": " + std::to_string(out.lostStamps.size()) +
            " pose(s) with NaN or infinity left out, the first at " +
            numberText(out.lostStamps.front(), 6) + " s");
    }
    std::size_t repeated = 0;
    const bool marked = std::any_of(
        poses.begin(), poses.end(), [](const auto& p) { return p.status != FrameStatus::Tracked; });
    const bool withCov =
        std::all_of(poses.begin(), poses.end(), [](const auto& p) { return p.cov.has_value(); });
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
        if (i + 1 < poses.size() && poses[i + 1].stamp == poses[i].stamp)
        {
            ++repeated;
            out.lostWithoutTime += poses[i].status == FrameStatus::Lost ? 1 : 0;
            continue;
        }
        out.stamps.push_back(poses[i].stamp);
        out.poses.push_back(poses[i].pose);
        if (marked)
        {
            out.status.push_back(poses[i].status);
        }
        if (withCov)
        {
            out.covs.push_back(*poses[i].cov);
            out.numbers.push_back(poses[i].number);
            out.sinceCovs.push_back(std::move(poses[i].sinceCovs));
        }
    }
    if (repeated > 0)
    {
        out.warnings.push_back(
            out.name + ": " + std::to_string(repeated) +
            " pose(s) with a repeated stamp; the last one of each was used");
    }
    warnOfNanoseconds(out);
    return out;
}

std::vector<double> pathLengths(const Trajectory& trajectory)
{
    return accumulate(
        trajectory, [](const Eigen::Isometry3d& T) { return T.translation().norm(); });
}

std::vector<double> accumulatedAngles(const Trajectory& trajectory)
{
    return accumulate(
        trajectory, [](const Eigen::Isometry3d& T) { return rotationAngle(T.linear()); });
}

double rotationAngle(const Eigen::Matrix3d& R)
{
    return std::acos(std::clamp((R.trace() - 1) / 2, -1.0, 1.0));
}

Trajectory withoutLost(Trajectory trajectory)
{
    if (std::find(trajectory.status.begin(), trajectory.status.end(), FrameStatus::Lost) ==
        trajectory.status.end())
    {
        return trajectory;
    }
    Trajectory out = trajectory;
    out.stamps.clear();
    out.poses.clear();
    out.covs.clear();
    out.sinceCovs.clear();
    out.numbers.clear();
    out.status.clear();
    for (std::size_t i = 0; i < trajectory.size(); ++i)
    {
        if (trajectory.status[i] == FrameStatus::Lost)
        {
            out.lostStamps.push_back(trajectory.stamps[i]);
            continue;
        }
        out.stamps.push_back(trajectory.stamps[i]);
        out.poses.push_back(trajectory.poses[i]);
        out.status.push_back(trajectory.status[i]);
        if (!trajectory.covs.empty())
        {
            out.covs.push_back(trajectory.covs[i]);
        }
    }
    std::sort(out.lostStamps.begin(), out.lostStamps.end());
    return out;
}

void checkOverlap(const Trajectory& groundTruth, const Trajectory& estimate, double offset)
{
    for (const Trajectory* t : {&groundTruth, &estimate})
    {
        if (t->size() < 2)
        {
            throw std::runtime_error(
                "'" + t->name + "' has " + std::to_string(t->size()) +
                " usable pose(s); at least two are needed");
        }
    }
    if (estimate.stamps.back() + offset < groundTruth.stamps.front() ||
        estimate.stamps.front() + offset > groundTruth.stamps.back())
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
            char text[160];
            std::snprintf(
                text,
                sizeof text,
                " is %g m away from the origin, beyond %g m, where digits are lost; are positions "
                "in metres?",
                distance,
                kFarthest);
            throw std::runtime_error(
                trajectory.name + ": the position at " + numberText(trajectory.stamps[i], 6) +
                " s" + (scale == 1 ? "" : " times " + numberText(scale, 3)) + text);
        }
    }
}

double longestStep(const std::vector<double>& stamps) { return 5 * medianInterval(stamps); }

std::vector<bool> holesBefore(const Trajectory& trajectory)
{
    const std::vector<double>& stamps = trajectory.stamps;
    const double longest = longestStep(stamps);
    std::vector<double> lost = trajectory.lostStamps;
    std::sort(lost.begin(), lost.end());
    std::vector<bool> out(trajectory.size(), false);
    for (std::size_t i = 1; i < trajectory.size(); ++i)
    {
        const auto next = std::upper_bound(lost.begin(), lost.end(), stamps[i - 1]);
        out[i] = stamps[i] - stamps[i - 1] > longest || (next != lost.end() && *next < stamps[i]);
    }
    return out;
}

double medianInterval(const std::vector<double>& stamps)
{
    std::vector<double> intervals;
    for (std::size_t i = 1; i < stamps.size(); ++i)
    {
        intervals.push_back(stamps[i] - stamps[i - 1]);
    }
    return intervals.empty() ? 0 : statisticsOf(intervals).median;
}

Trajectory withBody(Trajectory trajectory, const Eigen::Isometry3d& T_body_other)
{
    for (Eigen::Isometry3d& pose : trajectory.poses)
    {
        pose = pose * T_body_other;
    }
    const Matrix6d Ad = adjoint(T_body_other.inverse());
    for (std::vector<Matrix6d>& covs : trajectory.sinceCovs)
    {
        for (Matrix6d& cov : covs)
        {
            cov = propagate(Ad, cov);
        }
    }
    return trajectory;
}
}  // namespace pointplane
