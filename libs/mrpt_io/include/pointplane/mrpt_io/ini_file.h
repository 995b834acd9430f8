// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/config/CConfigFile.h>

#include <memory>
#include <string>

namespace pointplane
{
/** An ini file as MRPT reads it, which takes a missing one for an empty one, and the last of
 * several equal keys. \throws InputError that names the file, also for such keys and for what MRPT
 * cannot evaluate: `$eval{`, `@if` */
[[nodiscard]] std::unique_ptr<const mrpt::config::CConfigFile> openIniFile(const std::string& path);
}  // namespace pointplane
