// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/HtmlReport.h>

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "lab_runs.h"
#include <nlohmann/json.hpp>

namespace pointplane
{
/** Score of each value on each rawlog. */
struct SweepResult
{
    std::string parameter, protocol;
    std::vector<std::string> values, sequences;
    std::vector<LabScore> scores;  //!< of sequence s and value v: [s * values.size() + v]

    [[nodiscard]] const LabScore& at(std::size_t s, std::size_t v) const
    {
        return scores[s * values.size() + v];
    }
};

void printTable(const SweepResult& sweep, std::ostream& out);
[[nodiscard]] nlohmann::ordered_json toJson(const SweepResult& sweep);
[[nodiscard]] std::string toCsv(const SweepResult& sweep);
/** \param logarithmic axis of the values */
[[nodiscard]] HtmlReport reportOf(const SweepResult& sweep, bool logarithmic);
}  // namespace pointplane
