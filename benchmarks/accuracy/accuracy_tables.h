// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "MethodRun.h"
#include <nlohmann/json.hpp>

namespace pointplane
{
/** All methods on one sequence. */
struct SequenceScores
{
    std::string sequence;
    std::vector<MethodScore> methods;
};

/** A heading and one table, Markdown. */
[[nodiscard]] std::string markdownTable(const SequenceScores& scores);

/** A line a sequence: the first method against the best peer of each column, Markdown. */
[[nodiscard]] std::string markdownSummary(const std::vector<SequenceScores>& all);

/** A table for each measure: a line a method, a column a sequence, Markdown. */
[[nodiscard]] std::string markdownOverview(const std::vector<SequenceScores>& all);

[[nodiscard]] nlohmann::ordered_json toJson(const std::vector<SequenceScores>& all);
}  // namespace pointplane
