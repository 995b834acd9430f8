// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>

#include "tum_camera.h"
#include <nlohmann/json_fwd.hpp>

namespace pointplane
{
/** @name What the files beside the images of a folder say
 * All throw InputError naming the file.
 * @{ */

/** \throws InputError if it is none, or cannot be read */
void requireFolder(const std::string& path);

/** A 3x3 or 4x4 matrix, row by row. Its size is not in the file: 0x0. */
[[nodiscard]] PinholeCamera cameraOfMatrix(const std::filesystem::path& path);

/** A 4x4 matrix, row by row: a rotation and a translation [m]. */
[[nodiscard]] Eigen::Isometry3d poseOfMatrix(const std::filesystem::path& path);

/** A JSON file's object, or nothing if it is not there. */
[[nodiscard]] std::optional<nlohmann::json> jsonObjectIn(const std::filesystem::path& path);

/** \param path of the file, for the message */
[[nodiscard]] double numberAt(
    const nlohmann::json& json, const char* key, const std::filesystem::path& path);

/** Pixels of a side. */
[[nodiscard]] int pixelsIn(
    const nlohmann::json& json, const char* key, const std::filesystem::path& path);
/** @} */

[[nodiscard]] PinholeCamera pinholeOf(int width, int height, double f, double cx, double cy);
[[nodiscard]] TumCamera colourCamera(const PinholeCamera& camera);
}  // namespace pointplane
