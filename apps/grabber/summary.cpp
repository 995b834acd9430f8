// SPDX-License-Identifier: BSD-3-Clause
#include "summary.h"

#include <pointplane/core/counted.h>

#include <mrpt/core/format.h>

#include <ostream>

#include "ProgressBar.h"

namespace pointplane
{
namespace
{
void printLosses(const RunState& state, std::ostream& out)
{
    const auto& p = state.capture.pairing;
    const auto images = [](std::size_t depth, std::size_t colour)
    { return std::to_string(depth) + " depth and " + counted(colour, "colour image"); };
    out << "lost: " << images(p.droppedDepth, p.droppedColour) << " by the camera, "
        << images(p.unpairedDepth, p.unpairedColour) << " without a partner, "
        << counted(state.queueDrops, "pair") << " because the queue was full\n";
    if (state.queueDrops > 0)
    {
        out << "  the disk or the processor is too slow: a lower --compression, --jpeg or a larger "
               "--queue helps\n";
    }
}

void printTimes(const RunSummary& summary, std::ostream& out)
{
    const auto& capture = summary.state.capture;
    if (capture.pairing.pairs == 0)
    {
        return;
    }
    if (summary.camera.hasColour)
    {
        out << mrpt::format(
            "pairs: colour %+.1f ms after depth on average, %.1f ms apart at most\n",
            1e3 * capture.pairing.meanSkew,
            1e3 * capture.pairing.maxAbsSkew);
    }
    if (!summary.camera.isFile && capture.hasClock)
    {
        out << mrpt::format(
            "clock: UTC with the camera's spacing; host against camera %+.0f ppm\n",
            1e6 * capture.clockDrift);
    }
    if (capture.clockJumps > 0)
    {
        out << "  the camera's clock jumped " << counted(capture.clockJumps, "time") << "\n";
    }
}
}  // namespace

std::string describe(const CameraFacts& facts)
{
    const auto& d = facts.device;
    std::string text = d.uri;
    for (const auto& word : {d.vendor, d.name})
    {
        text += word.empty() ? "" : " " + word;
    }
    text += d.serial.empty() ? "" : ", serial " + d.serial;
    text += " (" + d.driver + "), " +
            toString({facts.mode.width, facts.mode.height, facts.mode.fps, ""});
    if (!facts.hasColour)
    {
        return text + ", depth only";
    }
    text += facts.registered ? ", depth registered to colour" : ", depth not registered";
    return text + (facts.synchronised ? ", synchronised" : "");
}

void print(const RunSummary& summary, std::ostream& out)
{
    const auto& state = summary.state;
    const double bytes = static_cast<double>(state.recording.bytesWritten);
    if (state.isRecording)
    {
        out << mrpt::format(
            "recorded %s, %s, %.1f MB (%.1f MB/s)%s",
            framesText(state.recording.framesWritten).c_str(),
            durationText(state.capture.recordedTime).c_str(),
            1e-6 * bytes,
            1e-6 * state.bytesPerSecond,
            summary.outputs.empty() ? "" : " to");
    }
    else
    {
        out << "saw " << framesText(state.capture.pairing.pairs) << ", "
            << durationText(state.capture.recordedTime) << (summary.outputs.empty() ? "" : ", to");
    }
    for (const auto& path : summary.outputs)
    {
        out << " " << path;
    }
    out << "\ncamera: " << describe(summary.camera) << "\ncalibration: " << summary.calibration
        << "\n";
    printLosses(state, out);
    printTimes(summary, out);
    if (summary.hasLive)
    {
        out << "live odometry: " << framesText(summary.live.processed) << ", "
            << summary.live.notTracked << " not tracked, " << summary.live.skipped << " skipped\n";
    }
    for (const auto& note : summary.notes)
    {
        out << "note: " << note << "\n";
    }
}
}  // namespace pointplane
