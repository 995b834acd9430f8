// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/points/PointReference.h>

namespace pointplane
{
void PointReference::note(
    const std::vector<PointTrack>& tracks, const std::vector<PointTrack>& others)
{
    misses.resize(points.size(), 0);
    for (int& count : misses)
    {
        ++count;
    }
    for (const std::vector<PointTrack>* found : {&tracks, &others})
    {
        for (const PointTrack& track : *found)
        {
            misses[static_cast<size_t>(track.ref)] = 0;
        }
    }
}

bool PointReference::isDue(size_t point) const
{
    constexpr int kPatience = 3, kTurns = 8;
    return point >= misses.size() || misses[point] < kPatience ||
           (misses[point] + static_cast<int>(point)) % kTurns == 0;
}
}  // namespace pointplane
