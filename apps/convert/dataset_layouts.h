// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "folder_layout.h"

namespace pointplane
{
/** @name Folders as data sets have them; nothing if this is none of theirs
 * @{ */

/** ScanNet, exported from .sens: each camera with its own size, and its pose in a common base
 * (usually the identity, as depth was moved to colour's axes). */
[[nodiscard]] std::optional<FolderLayout> scanNet(const std::filesystem::path& folder);

/** 7-Scenes: frame-000000.color.png, frame-000000.depth.png. Depth is not registered; the cameras
 * are those of a usual Kinect. */
[[nodiscard]] std::optional<FolderLayout> sevenScenes(const std::filesystem::path& folder);

/** Replica as rendered for iMAP and NICE-SLAM: results/frame000000.jpg, results/depth000000.png,
 * cam_params.json beside or above. */
[[nodiscard]] std::optional<FolderLayout> replica(const std::filesystem::path& folder);
/** @} */

/** Cameras of data sets, as published with them, by the name of the folder. */
void readPublishedCamera(const std::filesystem::path& folder, FolderLayout& out);

/** What Open3D's recorders write beside the images: intrinsic.json or camera_intrinsic.json. */
void readOpen3d(const std::filesystem::path& folder, FolderLayout& out);
}  // namespace pointplane
