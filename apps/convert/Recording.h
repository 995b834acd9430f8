// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/ScanWriter.h>
#include <pointplane/mrpt_io/errors.h>

#include <limits>
#include <optional>
#include <string>

namespace pointplane
{
/** A frame of a recording. */
struct RecordedFrame
{
    RegisteredScan scan;
    /** Stamp of depth minus that of colour [s]; NaN = not known. */
    double depthDelay{std::numeric_limits<double>::quiet_NaN()};
    bool isNominal{false};     //!< PinholeCamera::isNominal
    std::size_t numTooFar{0};  //!< readings that were left out of depth
};

/** One frame cannot be read, the next one may. The message names file or message. */
class BadFrame : public InputError
{
 public:
    using InputError::InputError;
};

/** RGB-D frames in their order, from wherever they are. */
class Recording
{
 public:
    virtual ~Recording() = default;

    /** \return nothing at the end \throws BadFrame, after which the next frame can be asked for;
     * InputError when there is no going on */
    [[nodiscard]] virtual std::optional<RecordedFrame> next() = 0;

    /** How much has been read, in [0, 1]. */
    [[nodiscard]] virtual double progress() const = 0;

    /** After the end: where the input stopped before its time, or empty. */
    [[nodiscard]] virtual std::string damage() const { return ""; }

    /** Poses of the camera that come with the images, a text of the TUM format, or empty. */
    [[nodiscard]] virtual std::string groundTruth() const { return ""; }

    /** What a user should know of how it was understood; lines without "\n". */
    [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
};
}  // namespace pointplane
