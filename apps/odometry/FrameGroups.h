// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/core/Clock.h>

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "FrameRecord.h"

namespace pointplane
{
/** Frames in a row of which one thing is told. */
struct FrameGroup
{
    std::size_t first{0}, last{0};  //!< frame numbers in the input
    mrpt::Clock::time_point stamp;  //!< of the first
    TrackingStatus status{TrackingStatus::Lost};
    std::string reason;  //!< of the first; of the others the same but for numbers in it
};

/** Frames that were not tracked, in groups of one reason. */
class UntrackedFrames
{
 public:
    void add(const OutputItem& item);

    /** A line for each of the first few groups. */
    void print(std::ostream& out) const;

    /** What is told of the first lost frames, or empty. */
    [[nodiscard]] std::string firstLost() const;

 private:
    std::vector<FrameGroup> groups_;  //!< the first few
    std::size_t numMore_{0};          //!< frames of the others
};

/** Tracked frames with a reason: they lack something. */
class FramesInPart
{
 public:
    void add(const OutputItem& item);

    /** How many, and the first one. Of a recording without colour, that is told once: else all its
     * frames would be in part. */
    void print(std::ostream& out, std::size_t numTracked) const;

 private:
    struct Frames
    {
        std::size_t number{0};
        FrameGroup first;

        void add(const OutputItem& item, const std::string& reason);
    };

    Frames all_;      //!< for any reason
    Frames besides_;  //!< for another reason than that colour is missing
    std::size_t numWithoutColour_{0};
};
}  // namespace pointplane
