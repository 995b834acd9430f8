// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/HtmlReport.h>

#include "reproduce_plan.h"
#include <nlohmann/json.hpp>

namespace pointplane
{
/** All scores of `reproduce`. */
struct Reproduction
{
    std::string protocol;
    std::vector<ReproducedSequence> sequences;
    std::vector<Variant> variants;
    std::vector<LabScore> scores;         //!< of sequence s, variant v: [s * variants.size() + v]
    std::vector<Variant> cornerVariants;  //!< of the simulated corner
    std::vector<LabScore> cornerScores;   //!< one each

    /** Score as text, or "-" when there is no such variant or sequence. */
    [[nodiscard]] std::string text(
        std::size_t sequence, const std::string& group, const std::string& name) const;
};

/** The paper's tables and Fig. 3 beside the published figures, the ablations, and what is missing:
 * Markdown, which is readable on a terminal too. */
[[nodiscard]] std::string toMarkdown(const Reproduction& result);
[[nodiscard]] nlohmann::ordered_json toJson(const Reproduction& result);
[[nodiscard]] std::string toCsv(const Reproduction& result);
[[nodiscard]] HtmlReport reportOf(const Reproduction& result);

/** Fig. 3: translation and rotation over alpha, a curve per sequence; none if it was not made. */
[[nodiscard]] std::vector<Chart> alphaCharts(const Reproduction& result);
}  // namespace pointplane
