// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/HtmlReport.h>
#include <pointplane/evaluation/compare.h>

#include <iosfwd>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace pointplane
{
/** @name What `compare` found, in every form of output.
 * \param protocol one line: all that is needed to repeat it
 * @{ */
void printTable(const Comparison& c, const std::string& protocol, std::ostream& out);
[[nodiscard]] nlohmann::ordered_json toJson(const Comparison& c, const std::string& protocol);
[[nodiscard]] std::string toCsv(const Comparison& c);
/** \param estimates of the compared runs, in their order \param hints for the reader */
[[nodiscard]] HtmlReport reportOf(
    const Comparison& c,
    const std::string& protocol,
    const RpeOptions& rpe,
    const Trajectory& truth,
    const std::vector<Trajectory>& estimates,
    const std::vector<std::string>& hints);
/** @} */
}  // namespace pointplane
