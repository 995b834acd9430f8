// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/Statistics.h>
#include <pointplane/evaluation/coverage.h>

#include <algorithm>
#include <cstdio>

namespace pointplane
{
namespace
{
struct Frame
{
    double stamp;
    bool tracked;
};

/** All frames of the recording, those without a pose too, in order of time. */
std::vector<Frame> framesOf(const Trajectory& estimate)
{
    std::vector<Frame> frames;
    for (std::size_t i = 0; i < estimate.size(); ++i)
    {
        frames.push_back(
            {estimate.stamps[i],
             estimate.status.empty() || estimate.status[i] == FrameStatus::Tracked});
    }
    for (const double stamp : estimate.lostStamps)
    {
        frames.push_back({stamp, false});
    }
    std::sort(
        frames.begin(),
        frames.end(),
        [](const Frame& a, const Frame& b) { return a.stamp < b.stamp; });
    return frames;
}

double medianInterval(const std::vector<Frame>& frames)
{
    std::vector<double> intervals;
    for (std::size_t i = 1; i < frames.size(); ++i)
    {
        intervals.push_back(frames[i].stamp - frames[i - 1].stamp);
    }
    return intervals.empty() ? 0 : statisticsOf(intervals).median;
}
}  // namespace

Coverage coverageOf(const Trajectory& groundTruth, const Trajectory& estimate, double offset)
{
    const std::vector<Frame> frames = framesOf(estimate);
    const double longest = 5 * medianInterval(frames);
    double tracked = 0;
    for (std::size_t i = 1; i < frames.size(); ++i)
    {
        if (frames[i].tracked && frames[i].stamp - frames[i - 1].stamp <= longest)
        {
            const double from = std::max(frames[i - 1].stamp + offset, groundTruth.stamps.front());
            const double to = std::min(frames[i].stamp + offset, groundTruth.stamps.back());
            tracked += std::max(0.0, to - from);
        }
    }
    Coverage out;
    out.ofRecording = estimate.marksFrames;
    const double whole = out.ofRecording && frames.size() > 1
                             ? frames.back().stamp - frames.front().stamp
                             : groundTruth.duration();
    out.share = whole > 0 ? tracked / whole : 0;
    const auto count = [&](FrameStatus status)
    {
        return static_cast<std::size_t>(
            std::count(estimate.status.begin(), estimate.status.end(), status));
    };
    out.predicted = count(FrameStatus::Predicted);
    out.lost = count(FrameStatus::Lost);
    out.tracked = estimate.size() - out.predicted - out.lost;
    out.lost += estimate.lostStamps.size() + estimate.lostWithoutTime;
    return out;
}

std::string describe(const Coverage& coverage)
{
    char out[160];
    if (coverage.ofRecording)
    {
        std::snprintf(
            out,
            sizeof out,
            "coverage %.1f %% of the recording: %zu frames tracked, %zu predicted, %zu lost",
            100 * coverage.share,
            coverage.tracked,
            coverage.predicted,
            coverage.lost);
    }
    else
    {
        std::snprintf(
            out,
            sizeof out,
            "coverage %.1f %% of the ground truth's time, frames not marked",
            100 * coverage.share);
    }
    return out;
}
}  // namespace pointplane
