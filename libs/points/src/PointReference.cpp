// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/points/PointReference.h>

namespace pointplane
{
void PointReference::note(std::initializer_list<const std::vector<PointTrack>*> found)
{
    misses.resize(points.size(), 0);
    for (int& count : misses)
    {
        ++count;
    }
    for (const std::vector<PointTrack>* tracks : found)
    {
        for (const PointTrack& track : *tracks)
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
