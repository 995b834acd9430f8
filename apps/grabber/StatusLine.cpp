// SPDX-License-Identifier: BSD-3-Clause
#include "StatusLine.h"

#include <pointplane/core/counted.h>

#include <mrpt/core/format.h>

#include <algorithm>
#include <ostream>

#include "ProgressBar.h"
#include "standard_streams.h"
#include <unistd.h>

namespace pointplane
{
namespace
{
constexpr double kMega = 1e6;

/** "30.0 fps  372 frames  lost: camera 0 ..." */
std::string statusText(const RunState& state)
{
    if (!state.capture.started)
    {
        return "waiting for the camera's streams to settle";
    }
    const auto& pairing = state.capture.pairing;
    const auto dropped =
        static_cast<unsigned long long>(pairing.droppedDepth + pairing.droppedColour);
    const auto unpaired =
        static_cast<unsigned long long>(pairing.unpairedDepth + pairing.unpairedColour);
    const auto late = static_cast<unsigned long long>(state.queueDrops);
    std::string text = mrpt::format(
        "%s  %.1f fps  %s  lost",
        durationText(state.capture.recordedTime).c_str(),
        state.capture.frameRate,
        framesText(pairing.pairs).c_str());
    text += dropped + unpaired + late == 0
                ? " 0"
                : mrpt::format(": camera %llu, unpaired %llu, queue %llu", dropped, unpaired, late);
    if (state.isRecording)
    {
        const double written = static_cast<double>(state.recording.bytesWritten);
        text += mrpt::format(
            "  queue %zu/%zu  %.0f MB  free %.0f MB",
            state.recording.framesQueued,
            state.queueCapacity,
            written / kMega,
            state.freeBytes / kMega);
        if (state.bytesPerSecond > 0.0)
        {
            text += " (" + durationText(state.freeBytes / state.bytesPerSecond) + " left)";
        }
    }
    return text;
}
}  // namespace

StatusLine::StatusLine(std::ostream& out, bool isTerminal) : out_(out), isTerminal_(isTerminal) {}

void StatusLine::update(const RunState& state)
{
    const auto now = Clock::now();
    if (now - drawn_ < (isTerminal_ ? std::chrono::milliseconds(500) : std::chrono::seconds(10)))
    {
        return;
    }
    drawn_ = now;
    std::string text = statusText(state);
    if (!isTerminal_)
    {
        out_ << text << std::endl;
        return;
    }
    text = lineOf("", text, columnsOf(STDERR_FILENO));
    const std::size_t previous = width_;
    width_ = text.size();
    text.resize(std::max(width_, previous), ' ');
    out_ << "\r" << text << std::flush;
}

void StatusLine::end()
{
    if (width_ > 0)
    {
        out_ << std::endl;
        width_ = 0;
    }
}
}  // namespace pointplane
