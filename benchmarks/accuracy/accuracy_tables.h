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

/** A heading and one table with all measures, Markdown. */
[[nodiscard]] std::string markdownTable(const SequenceScores& scores);

/** A line a sequence: the first method against the least errors of the peers (bold where it is
 * behind), and its NEES; Markdown. */
[[nodiscard]] std::string markdownSummary(const std::vector<SequenceScores>& all);

/** Relative pose errors: a line a method, a column a sequence, Markdown. */
[[nodiscard]] std::string markdownOverview(const std::vector<SequenceScores>& all);

/** \throws IncompleteError naming the first sequence on which one of our methods failed */
void requireNoFailures(const std::vector<SequenceScores>& all);

[[nodiscard]] nlohmann::ordered_json toJson(const std::vector<SequenceScores>& all);
}  // namespace pointplane
