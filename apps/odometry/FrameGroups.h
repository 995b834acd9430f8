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

    /** Of a recording without colour, those that lack more: else all would be in part. */
    [[nodiscard]] std::size_t number(std::size_t numTracked) const;

    /** The first one, and whether the recording is without colour. */
    void print(std::ostream& out, std::size_t numTracked) const;

 private:
    struct Frames
    {
        std::size_t number{0};
        FrameGroup first;

        void add(const OutputItem& item, const std::string& reason);
    };

    [[nodiscard]] bool areAllWithoutColour(std::size_t numTracked) const;

    Frames all_;      //!< for any reason
    Frames besides_;  //!< for another reason than that colour is missing
    std::size_t numWithoutColour_{0};
};
}  // namespace pointplane
