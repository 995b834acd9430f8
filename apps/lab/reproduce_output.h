// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/HtmlReport.h>

#include "Reproduction.h"
#include <nlohmann/json.hpp>

namespace pointplane
{
/** The paper's tables and Fig. 3 beside the published figures, the ablations, and what is missing:
 * Markdown, which is readable on a terminal too. */
[[nodiscard]] std::string toMarkdown(const Reproduction& result);
[[nodiscard]] nlohmann::ordered_json toJson(const Reproduction& result);
[[nodiscard]] std::string toCsv(const Reproduction& result);
[[nodiscard]] HtmlReport reportOf(const Reproduction& result);

/** A picture and the name of its file, "paper_fig3_rotation.svg". */
struct NamedChart
{
    std::string fileName;
    Chart chart;
};

/** Fig. 3, translation and rotation over alpha with a curve per sequence, and Fig. 5, the poses in
 * the corner by planes and by points and planes; those that were made. */
[[nodiscard]] std::vector<NamedChart> figuresOf(const Reproduction& result);
}  // namespace pointplane
