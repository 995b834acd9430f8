// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "folder_layout.h"
#include "pose_numbers.h"

namespace pointplane
{
/** Poses of a trajectory as Redwood and Open3D write it: for each frame a line of three numbers,
 * the third that of its depth image, counted from 1, and the four rows of its matrix.
 * \throws InputError naming file and line */
[[nodiscard]] NumberedPoses readTrajectoryLog(const std::filesystem::path& path);

/** The poses of trajectory.log, else of the only trajectory in the folder (.log, traj.txt), if
 * there is any. */
void readTrajectoryIn(const std::filesystem::path& folder, FolderLayout& out);
}  // namespace pointplane
