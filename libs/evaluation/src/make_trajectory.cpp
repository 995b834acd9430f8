// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/counted.h>
#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/Trajectory.h>
#include <pointplane/evaluation/stamp_intervals.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pointplane
{
namespace
{
/** Tells the user of so many things, if there are any. \param what one of them \param ofThem what
 * follows it */
void warn(
    Trajectory& trajectory, std::size_t count, const std::string& what, const std::string& ofThem)
{
    if (count > 0)
    {
        trajectory.warnings.push_back(trajectory.name + ": " + counted(count, what) + ofThem);
    }
}

/** Numbers poses in the order of their file, and removes those whose stamp is no number, and those
 * of lost frames whose stamp is not after that of the pose before: where the camera was at that
 * time, they do not tell. */
void removeLate(std::vector<StampedPose>& poses, Trajectory& out)
{
    std::vector<StampedPose> kept;
    std::size_t withoutStamp = 0;
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
        poses[i].number = i;
        const bool isLost = poses[i].status == FrameStatus::Lost;
        const bool isAfter = kept.empty() || poses[i].stamp > kept.back().stamp;
        if (std::isfinite(poses[i].stamp) && (isAfter || !isLost))
        {
            kept.push_back(std::move(poses[i]));
        }
        else
        {
            ++(isLost ? out.lostWithoutTime : withoutStamp);
        }
    }
    poses = std::move(kept);
    warn(out, withoutStamp, "pose", " without a time stamp left out");
    warn(
        out,
        out.lostWithoutTime,
        "lost frame",
        " without a pose, as the stamp is not after the one before");
}

/** Lost frames are before others of the same stamp. */
void sortByStamp(std::vector<StampedPose>& poses, Trajectory& out)
{
    std::size_t numBack = 0, first = 0;
    for (std::size_t i = 1; i < poses.size(); ++i)
    {
        if (poses[i].stamp < poses[i - 1].stamp && numBack++ == 0)
        {
            first = i;
        }
    }
    if (numBack > 0)
    {
        warn(
            out,
            numBack,
            "step",
            " back in time, the first one from " + numberText(poses[first - 1].stamp, 6) + " to " +
                numberText(poses[first].stamp, 6) +
                " s: poses were sorted by time; score two recordings apart");
    }
    const auto key = [](const StampedPose& p)
    { return std::make_pair(p.stamp, p.status != FrameStatus::Lost); };
    std::stable_sort(
        poses.begin(),
        poses.end(),
        [&](const StampedPose& a, const StampedPose& b) { return key(a) < key(b); });
}

/** Of poses that are no numbers, only the stamps are kept. */
void removeNotFinite(std::vector<StampedPose>& poses, Trajectory& out)
{
    const auto bad = std::stable_partition(
        poses.begin(), poses.end(), [](const auto& p) { return p.pose.matrix().allFinite(); });
    for (auto pose = bad; pose != poses.end(); ++pose)
    {
        out.lostStamps.push_back(pose->stamp);
    }
    poses.erase(bad, poses.end());
    if (!out.lostStamps.empty())
    {
        warn(
            out,
            out.lostStamps.size(),
            "pose",
            " with NaN or infinity left out, the first at " +
                numberText(out.lostStamps.front(), 6) + " s");
    }
}

/** The last one of each stamp. */
void takePoses(std::vector<StampedPose>& poses, Trajectory& out)
{
    const bool marked = std::any_of(
        poses.begin(), poses.end(), [](const auto& p) { return p.status != FrameStatus::Tracked; });
    const bool withCov =
        std::all_of(poses.begin(), poses.end(), [](const auto& p) { return p.cov.has_value(); });
    std::size_t repeated = 0;
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
    warn(out, repeated, "pose", " with a repeated stamp; the last one of each was used");
}

void warnOfNanoseconds(Trajectory& trajectory)
{
    constexpr double kLongest = 1000;  // [s]
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
}  // namespace

Trajectory makeTrajectory(std::string name, std::vector<StampedPose> poses)
{
    Trajectory out;
    out.name = std::move(name);
    removeLate(poses, out);
    sortByStamp(poses, out);
    removeNotFinite(poses, out);
    takePoses(poses, out);
    warnOfNanoseconds(out);
    return out;
}
}  // namespace pointplane
