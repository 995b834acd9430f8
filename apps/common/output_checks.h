// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** @name What an output needs, before the run finds out
 * \param option that names it, e.g. "--trajectory" \param path as given
 * \throws InputError, in one line that names both, for a name that cannot be an output
 * \throws EnvironmentError, likewise, if it cannot be written
 * @{ */
void requireWritableFile(const std::string& option, const std::string& path);
/** One that is made if need be. */
void requireWritableFolder(const std::string& option, const std::string& path);
/** Whether the disk takes the name under which it is written. */
void requireShortName(
    const std::string& option, const std::string& path, const std::string& written);
/** @} */
}  // namespace pointplane
