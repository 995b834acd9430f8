// SPDX-License-Identifier: BSD-3-Clause
#include "RunSummary.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cstdio>
#include <ostream>

namespace pointplane
{
void RunSummary::add(const OutputItem& item)
{
    const RobotMotion& motion = item.frame->motion;
    ++numFrames;
    switch (motion.status)
    {
        case TrackingStatus::First:
        case TrackingStatus::Tracked:
            ++numTracked;
            break;
        case TrackingStatus::Predicted:
            ++numPredicted;
            break;
        case TrackingStatus::Lost:
            ++numLost;
            break;
    }
    pathLength += motion.increment.mean.norm();
    const FrameDiagnostics& d = motion.diagnostics;
    sum.msPoints += d.msPoints;
    sum.msPlanes += d.msPlanes;
    sum.msMatching += d.msMatching;
    sum.msPose += d.msPose;
    sum.msTotal += d.msTotal;
}

void RunSummary::print(std::ostream& out, bool profile) const
{
    char line[256];
    const auto frames = static_cast<double>(std::max<std::size_t>(1, numFrames));
    std::snprintf(
        line,
        sizeof(line),
        "%s: %zu frames: %zu tracked, %zu predicted, %zu lost; path %.3f m; %.1f ms/frame "
        "(odometry "
        "%.1f), %.1f fps\n",
        label.c_str(),
        numFrames,
        numTracked,
        numPredicted,
        numLost,
        pathLength,
        1e3 * seconds / frames,
        sum.msTotal / frames,
        frames / std::max(seconds, 1e-9));
    out << line;
    if (profile)
    {
        std::snprintf(
            line,
            sizeof(line),
            "ms/frame: points %.2f, planes %.2f, matching %.2f, pose %.2f, total %.2f\n",
            sum.msPoints / frames,
            sum.msPlanes / frames,
            sum.msMatching / frames,
            sum.msPose / frames,
            sum.msTotal / frames);
        out << line;
    }
    for (const std::string& output : outputs)
    {
        out << output << "\n";
    }
}

int RunSummary::exitCode() const
{
    return damage.empty() && numUnusable == 0 ? kExitOk : kExitIncomplete;
}
}  // namespace pointplane
