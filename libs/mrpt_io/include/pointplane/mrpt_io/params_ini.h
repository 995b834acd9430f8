// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/OdometryParams.h>

#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace pointplane
{
/** One key of a parameter group, bound to the member that holds its value. */
struct ParameterRef
{
    std::string section;
    std::string key;
    std::variant<bool*, int*, double*, std::string*> value;
    std::string unit;  //!< "-" for none
    std::string help;

    [[nodiscard]] std::string text() const;  //!< the value as it stands in an ini file
    [[nodiscard]] const char* typeName() const;
};
using ParameterTable = std::vector<ParameterRef>;

/** The keys of one group, through its visit(). The group must outlive the table. */
template <class Group>
[[nodiscard]] ParameterTable parametersOf(const std::string& section, Group& group)
{
    ParameterTable table;
    group.visit(
        [&](const char* key, auto& value, const char* unit, const char* help) {
            table.push_back({section, key, &value, unit, help});
        });
    return table;
}

/** The keys of all groups, through visitSections(). */
template <class Params>
[[nodiscard]] ParameterTable parametersOf(Params& params)
{
    ParameterTable table;
    params.visitSections(
        [&](const char* section, auto& group)
        {
            for (auto& parameter : parametersOf(section, group))
            {
                table.push_back(std::move(parameter));
            }
        });
    return table;
}

/** @name Strict ini files
 *
 * `[Section]`, then `key = value // comment`. `//` starts a comment anywhere, `#` and `;` only on a
 * line of their own. Keys left out keep their defaults. MRPT's own reader takes "abc" for 0,
 * ignores unknown keys and takes missing files for empty. Here all of that is an error that names
 * file, line, section, key, and the closest valid key.
 * @{ */

/** Sets the values of the table from a file. \throws InputError */
void loadIni(const std::string& path, const ParameterTable& table);

/** As loadIni() from text; `name` stands for the file in messages. \throws InputError */
void parseIni(const std::string& text, const std::string& name, const ParameterTable& table);

/** Applies settings of the form "Section.key=value". \throws InputError, also for a key that is
 * set twice */
void applySettings(const std::vector<std::string>& settings, const ParameterTable& table);

/** An ini file of all keys, with units and help.
 * \param firstExpert section before which a line says that the rest is for experts; empty = none */
[[nodiscard]] std::string iniText(const ParameterTable& table, const std::string& firstExpert = "");

/** The same as a Markdown table per section. */
[[nodiscard]] std::string markdownText(
    const ParameterTable& table, const std::string& firstExpert = "");
/** @} */

/** Defaults, then the file, then the settings, then the check of ranges.
 * \param path may be empty: defaults only
 * \throws InputError */
[[nodiscard]] OdometryParams loadOdometryParams(
    const std::string& path, const std::vector<std::string>& settings = {});
}  // namespace pointplane
