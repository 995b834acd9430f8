// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
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

    [[nodiscard]] std::string name() const;  //!< "[section] key"
    [[nodiscard]] std::string text() const;  //!< the value as it stands in an ini file
    /** From the same text. \throws InputError if it is not of this type */
    void set(const std::string& text) const;
    [[nodiscard]] const char* typeName() const;  //!< "a number"
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

/** \throws InputError that tells the closest name if there is no such section, or no such key in it
 * @{ */
void requireSection(const ParameterTable& table, const std::string& section);
[[nodiscard]] const ParameterRef& parameterOf(
    const ParameterTable& table, const std::string& section, const std::string& key);
/** @} */
}  // namespace pointplane
