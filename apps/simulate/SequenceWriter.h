// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/simulation/SimulatedSequence.h>

#include <iosfwd>
#include <string>

namespace pointplane
{
struct SequenceOutput
{
    std::string path;  //!< of the rawlog
    std::string label{"RGBD"};
    bool external{false};
    bool hideShutter{false};
    bool masks{false};                  //!< what moves, as pictures in masksFolderOf(path)
    std::string truthFrame{"optical"};  //!< whose poses the ground truth holds, or "robot"
    bool quiet{false};
    std::string description;  //!< goes into a comment at the beginning, to render it again
};

/** NAME_Masks beside NAME.rawlog. */
[[nodiscard]] std::string masksFolderOf(const std::string& rawlog);

/** Renders all frames into a rawlog and writes the truth beside it, as TUM text; not where the
 * rawlog is a pipe or a device. Frames are
 * rendered by several threads; the bytes do not depend on how many. \throws EnvironmentError */
void writeSequence(
    const SimulatedSequence& sequence, const SequenceOutput& output, std::ostream& progress);
}  // namespace pointplane
