// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
/** One picture of a folder: a file, or a frame of a video. */
struct ImageRef
{
    std::string path;
    long key{0};                  //!< its number
    bool isNumbered{true};        //!< false: the name is a time, key is 0
    std::optional<double> stamp;  //!< where name or list tell it [s]
};

/** Images of a folder, if there is one, whose names start and end as given, in order of their
 * number or time.
 *
 * What is between is a number (frame 17), a time since 1970 (seconds with a decimal point, or 10,
 * 13, 16 or 19 digits: seconds, milli-, micro- or nanoseconds), or two numbers with a dash
 * (Redwood: frame and microseconds). Other names are left out.
 * \throws InputError if the folder is there, but cannot be read */
[[nodiscard]] std::vector<ImageRef> imagesIn(
    const std::filesystem::path& folder,
    const std::string& prefix = "",
    const std::string& suffix = "");

/** Paths of all images in a folder, whatever their names; hidden files are none. */
[[nodiscard]] std::vector<std::string> imagesInFolder(const std::filesystem::path& folder);

/** Names of the images in the folders of these that are none of them: their names are no numbers.
 */
[[nodiscard]] std::vector<std::string> imagesBeside(const std::vector<ImageRef>& images);

/** Whether the folder's own name holds these whole words: "fr1" is in scans/fr1_desk, but neither
 * in fr1_scans/desk nor in fr10. */
[[nodiscard]] bool isInNameOf(const std::filesystem::path& folder, const std::string& words);
}  // namespace pointplane
