// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "folder_layout.h"

namespace pointplane
{
/** StrayScanner: rgb.mp4, depth/000000.png in millimetres, camera_matrix.csv, odometry.csv; nothing
 * if this is no folder of it. */
[[nodiscard]] std::optional<FolderLayout> strayScanner(const std::filesystem::path& folder);

/** Record3D's metadata, where there is any: K column by column, sizes of colour and depth, rate,
 * stamps. */
void readRecord3d(const std::filesystem::path& folder, FolderLayout& out);
}  // namespace pointplane
