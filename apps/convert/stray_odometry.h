// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>

#include "pose_numbers.h"

namespace pointplane
{
/** What StrayScanner's odometry.csv tells, by the numbers of frames. */
struct StrayOdometry
{
    std::map<long, double> stamps;  //!< [s]
    /** Of the optical frame: the recorder turns ARKit's camera, which looks along -z. */
    NumberedPoses poses;
};

/** Reads lines `timestamp, frame, x, y, z, qx, qy, qz, qw`. More columns are left out; without
 * those of the pose, there is none. So is a last line that is cut off.
 * \throws InputError naming file and line */
[[nodiscard]] StrayOdometry readStrayOdometry(const std::filesystem::path& path);
}  // namespace pointplane
