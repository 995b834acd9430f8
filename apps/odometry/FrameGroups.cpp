// SPDX-License-Identifier: BSD-3-Clause
#include "FrameGroups.h"

#include <pointplane/core/counted.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/system/datetime.h>

#include <algorithm>
#include <ostream>

namespace pointplane
{
namespace
{
constexpr std::size_t kMostGroups = 8;  // lines that are still read

/** Reasons that differ in numbers alone are one reason. */
[[nodiscard]] std::string withoutNumbers(std::string text)
{
    text.erase(
        std::remove_if(
            text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || c == '.'; }),
        text.end());
    return text;
}

/** A reason without that of frames that have depth alone, which is the last one. */
[[nodiscard]] std::string withoutColour(const std::string& reason)
{
    const std::size_t at = reason.rfind("it has no colour image");
    return at == std::string::npos ? reason : reason.substr(0, std::max<std::size_t>(at, 2) - 2);
}

[[nodiscard]] FrameGroup groupOf(const OutputItem& item, const std::string& reason)
{
    const std::size_t index = item.source.frameIndex;
    return {index, index, item.source.observation->timestamp, item.frame->motion.status, reason};
}

[[nodiscard]] std::string lineOf(const FrameGroup& frames)
{
    const std::string first = std::to_string(frames.first);
    return (frames.first == frames.last ? "frame " + first
                                        : "frames " + first + "-" + std::to_string(frames.last)) +
           (frames.stamp == INVALID_TIMESTAMP ? "" : " (stamp " + stampText(frames.stamp) + ")") +
           ": " + toString(frames.status) + ": " + frames.reason;
}
}  // namespace

void UntrackedFrames::add(const OutputItem& item)
{
    const RobotMotion& motion = item.frame->motion;
    const std::size_t index = item.source.frameIndex;
    const bool continues = !groups_.empty() && numMore_ == 0 && groups_.back().last + 1 == index &&
                           groups_.back().status == motion.status &&
                           withoutNumbers(groups_.back().reason) == withoutNumbers(motion.reason);
    if (continues)
    {
        groups_.back().last = index;
    }
    else if (groups_.size() < kMostGroups)
    {
        groups_.push_back(groupOf(item, motion.reason));
    }
    else
    {
        ++numMore_;
    }
}

void UntrackedFrames::print(std::ostream& out) const
{
    for (const FrameGroup& group : groups_)
    {
        out << "  " << lineOf(group) << "\n";
    }
    if (numMore_ > 0)
    {
        out << "  and " << framesText(numMore_)
            << " after these (--diagnostics FILE has them all)\n";
    }
}

std::string UntrackedFrames::firstLost() const
{
    const auto lost = std::find_if(
        groups_.begin(),
        groups_.end(),
        [](const FrameGroup& group) { return group.status == TrackingStatus::Lost; });
    return lost == groups_.end() ? "" : lineOf(*lost);
}

void FramesInPart::Frames::add(const OutputItem& item, const std::string& reason)
{
    if (number++ == 0)
    {
        first = groupOf(item, reason);
    }
}

void FramesInPart::add(const OutputItem& item)
{
    const std::string& reason = item.frame->motion.reason;
    const std::string besides = withoutColour(reason);
    numWithoutColour_ += besides == reason ? 0 : 1;
    if (!reason.empty())
    {
        all_.add(item, reason);
    }
    if (!besides.empty())
    {
        besides_.add(item, besides);
    }
}

bool FramesInPart::areAllWithoutColour(std::size_t numTracked) const
{
    return numWithoutColour_ > 0 && numWithoutColour_ == numTracked;
}

std::size_t FramesInPart::number(std::size_t numTracked) const
{
    return (areAllWithoutColour(numTracked) ? besides_ : all_).number;
}

void FramesInPart::print(std::ostream& out, std::size_t numTracked) const
{
    if (areAllWithoutColour(numTracked))
    {
        out << "  no tracked frame has a colour image: the motion is from planes, without points\n";
    }
    if (number(numTracked) > 0)
    {
        const Frames& frames = areAllWithoutColour(numTracked) ? besides_ : all_;
        out << "  in part, first " << lineOf(frames.first) << "\n";
    }
}
}  // namespace pointplane
