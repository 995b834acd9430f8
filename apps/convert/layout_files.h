// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration_file.h"
#include <nlohmann/json_fwd.hpp>

namespace pointplane
{
/** @name What the files beside the images of a folder say
 * All throw InputError naming the file.
 * @{ */

/** \throws InputError if it is none, or cannot be read */
void requireFolder(const std::string& path);

/** The numbers of a line, separated by blanks or commas; also nan and inf.
 * \param where file and line, for the message */
[[nodiscard]] std::vector<double> numbersInLine(std::string line, const std::string& where);

/** A 3x3 or 4x4 matrix, row by row. Its size is not in the file: 0x0. */
[[nodiscard]] PinholeCamera cameraOfMatrix(const std::filesystem::path& path);

/** A 4x4 matrix, row by row: a rotation and a translation [m]. */
[[nodiscard]] Eigen::Isometry3d poseOfMatrix(const std::filesystem::path& path);

/** The same where a file may say that there is no pose, or be lost. Does not throw. */
[[nodiscard]] std::optional<Eigen::Isometry3d> poseIn(const std::filesystem::path& path);

/** Such matrices, one a line; nothing where a line is none. Empty if there is no file. */
[[nodiscard]] std::vector<std::optional<Eigen::Isometry3d>> posesInLines(
    const std::filesystem::path& path);

/** What a JSON file holds, or nothing if it is not there. */
[[nodiscard]] std::optional<nlohmann::json> jsonIn(const std::filesystem::path& path);

/** As jsonIn(), of a file that has to hold an object. */
[[nodiscard]] std::optional<nlohmann::json> jsonObjectIn(const std::filesystem::path& path);

/** \param path of the file, for the message */
[[nodiscard]] double numberAt(
    const nlohmann::json& json, const char* key, const std::filesystem::path& path);

/** Pixels of a side. */
[[nodiscard]] int pixelsIn(
    const nlohmann::json& json, const char* key, const std::filesystem::path& path);

/** Frames a second by 'fps', or nothing if the file does not tell them. */
[[nodiscard]] std::optional<double> rateIn(
    const nlohmann::json& json, const std::filesystem::path& path);

/** Keys of a camera: its matrix of 9 numbers, and the size of its images. */
struct CameraKeys
{
    const char *matrix, *width, *height;
};

/** A matrix column by column, as Open3D and Record3D write it, or row by row, as others make it. */
[[nodiscard]] PinholeCamera cameraAt(
    const nlohmann::json& json, const CameraKeys& keys, const std::filesystem::path& path);

/** Open3D's calibration, or nothing if it is none. */
[[nodiscard]] std::optional<Calibration> open3dCamera(
    const nlohmann::json& json, const std::filesystem::path& path);
/** @} */

[[nodiscard]] PinholeCamera pinholeOf(int width, int height, double f, double cx, double cy);
[[nodiscard]] Calibration colourCamera(const PinholeCamera& camera);
}  // namespace pointplane
