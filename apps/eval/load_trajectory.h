// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>

#include <string>

namespace pointplane
{
struct CommandContext;

/** Reads any supported trajectory file, told apart by the name's ending: .rawlog, .simplemap (both
 * also .gz), anything else is text. Prints its warnings; a damaged file sets exit code 1.
 * \param sensorLabel of the poses in a rawlog; empty: the only one there is
 * \throws std::runtime_error that names the file (and line) when it cannot be read */
[[nodiscard]] Trajectory loadTrajectory(
    const std::string& path, const std::string& sensorLabel, CommandContext& context);
}  // namespace pointplane
