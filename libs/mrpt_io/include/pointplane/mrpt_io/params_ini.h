// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/ParameterTable.h>
#include <pointplane/odometry/OdometryParams.h>

#include <string>
#include <vector>

namespace pointplane
{
/** @name Strict ini files
 *
 * `[Section]`, then `key = value // comment`. `//` starts a comment anywhere, `#` and `;` only on a
 * line of their own. Keys left out keep their defaults. MRPT's own reader takes "abc" for 0,
 * ignores unknown keys and takes missing files for empty. Here all of that is an error that names
 * file, line, section, key, and the closest valid key.
 * @{ */

/** Sets the values of the table. \param text of the file \param name of it, for messages
 * \throws InputError */
void parseIni(const std::string& text, const std::string& name, const ParameterTable& table);

/** Applies settings of the form "Section.key=value". \throws InputError, also for a key that is
 * set twice */
void applySettings(const std::vector<std::string>& settings, const ParameterTable& table);

/** An ini file of all keys, with units and help.
 * \param firstExpert section before which a line says that the rest is for experts; empty = none */
[[nodiscard]] std::string iniText(const ParameterTable& table, const std::string& firstExpert = "");
/** @} */

/** Defaults, then the file, then the settings, then the check of ranges.
 * \param path may be empty: defaults only
 * \throws InputError */
[[nodiscard]] OdometryParams loadOdometryParams(
    const std::string& path, const std::vector<std::string>& settings = {});
}  // namespace pointplane
