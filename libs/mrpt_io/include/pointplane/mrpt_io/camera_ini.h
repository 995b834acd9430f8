// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/config/CConfigFile.h>
#include <mrpt/img/TCamera.h>

#include <cstddef>
#include <string>
#include <vector>

namespace pointplane
{
/** @name Calibrations in ini files. MRPT's own reader takes `abc` for 0 and `318,5` for 318.
 * \throws InputError naming file, section and key
 * @{ */

/** \param file from openIniFile(path) \return as many numbers as asked for, of `[1 2 3]` or `1` */
[[nodiscard]] std::vector<double> numbersInIni(
    const mrpt::config::CConfigFile& file,
    const std::string& path,
    const std::string& section,
    const std::string& key,
    std::size_t count);

/** One number, or `fallback` where there is no such key. */
[[nodiscard]] double numberInIni(
    const mrpt::config::CConfigFile& file,
    const std::string& path,
    const std::string& section,
    const std::string& key,
    double fallback);

/** Of the keys resolution, fx, fy, cx, cy, dist and distortion_model. Files from before there was a
 * distortion_model mean plumb bob; MRPT ignores their `dist`. What k1 k2 p1 p2 k3 cannot tell is
 * refused. */
[[nodiscard]] mrpt::img::TCamera cameraInIni(
    const mrpt::config::CConfigFile& file, const std::string& path, const std::string& section);
/** @} */
}  // namespace pointplane
