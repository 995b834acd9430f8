// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/core/Clock.h>

#include <string>
#include <vector>

namespace pointplane
{
/** One line of rgb.txt or depth.txt. */
struct TumImage
{
    mrpt::Clock::time_point stamp;
    double seconds{0};  //!< the same
    std::string path;   //!< with the folder
};

/** Reads `stamp file` lines in order of time; '#' starts a comment line. Names may have blanks.
 * A line that is there twice counts once.
 * \param folder \param listing name in it, e.g. "rgb.txt"
 * \throws InputError naming file and line */
[[nodiscard]] std::vector<TumImage> readTumListing(
    const std::string& folder, const std::string& listing);
}  // namespace pointplane
