// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>

#include <iosfwd>
#include <string>

namespace pointplane
{
/** Reads any supported trajectory file, by its name's ending, and prints its warnings.
 * Throws std::runtime_error that names the file (and line) when it cannot be read. */
[[nodiscard]] Trajectory loadTrajectory(const std::string& path, std::ostream& err);
}  // namespace pointplane
