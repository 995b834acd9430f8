// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** groundtruth.txt of a folder as TUM's. */
struct TumTruth
{
    std::string text;  //!< poses of the camera; empty if there are none
    std::string note;  //!< what people should know of it, or empty
};

/** As the file is, or moved to the camera: Bonn's data set has the poses of markers on it.
 * \throws InputError if there is a file that cannot be read */
[[nodiscard]] TumTruth readTumTruth(const std::string& folder);
}  // namespace pointplane
