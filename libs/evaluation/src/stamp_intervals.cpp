// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/Statistics.h>
#include <pointplane/evaluation/stamp_intervals.h>

#include <algorithm>

namespace pointplane
{
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
}  // namespace pointplane
