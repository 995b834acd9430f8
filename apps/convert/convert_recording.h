// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "Recording.h"

namespace pointplane
{
struct RecordingOutput
{
    std::string path;  //!< rawlog to write
    std::string label{"RGBD"};
    bool external{false};  //!< images as files in <path>_Images
    bool strict{false};    //!< a frame that cannot be read ends the run
    bool quiet{false};
};

struct RecordingSummary
{
    std::size_t numFrames{0}, numBad{0};
    std::vector<std::string> problems;  //!< of the first bad frames
    std::string damage;                 //!< where the input ended early, or empty
    std::string stamps;                 //!< what is wrong with the stamps, or empty
    std::string camera;                 //!< oddityOf() of the first frame, or empty
    std::size_t numWithoutDepth{0};     //!< frames without any reading
    std::size_t numTooFar{0};           //!< readings that the rawlog cannot hold
    double depth{0};  //!< median of the first frame that has any [m]: tells wrong units
};

/** Writes a recording as a rawlog. Frames that cannot be read are counted and left out, or end the
 * run as an InputError (`strict`).
 * \throws InputError, EnvironmentError; InputError, too, when not one frame can be read */
[[nodiscard]] RecordingSummary convertRecording(
    Recording& recording, const RecordingOutput& output, std::ostream& progress);

/** The summary for people. \return the exit code (mrpt_io/errors.h) */
[[nodiscard]] int report(
    const RecordingSummary& summary,
    const RecordingOutput& output,
    const std::vector<std::string>& notes,
    std::ostream& out,
    std::ostream& err);
}  // namespace pointplane
