// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Capture.h>
#include <pointplane/grabber/RecordingWriter.h>

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <string>

namespace pointplane
{
/** What the status line and the summary show. */
struct RunState
{
    CaptureStats capture;
    RecordingStats recording;
    bool isRecording{false};
    std::size_t queueCapacity{0};
    std::uint64_t queueDrops{0};  //!< pairs lost because the disk was too slow
    double freeBytes{0};          //!< on the disk of the output
    double bytesPerSecond{0};     //!< written, over the whole recording
};

/** One line that is redrawn on a terminal; elsewhere a line every ten seconds. */
class StatusLine
{
 public:
    StatusLine(std::ostream& out, bool isTerminal);

    /** Draws if it is time to. */
    void update(const RunState& state);
    void end();

 private:
    using Clock = std::chrono::steady_clock;
    std::ostream& out_;
    bool isTerminal_;
    Clock::time_point drawn_{Clock::now()};
    std::size_t width_{0};
};
}  // namespace pointplane
