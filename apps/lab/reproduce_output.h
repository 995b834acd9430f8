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
    RpeOptions rpe;
    std::vector<ReproducedSequence> sequences;
    std::vector<Trajectory> truths;  //!< one each
    std::vector<Variant> variants;
    std::vector<LabScore> scores;         //!< of sequence s, variant v: [s * variants.size() + v]
    std::vector<Variant> cornerVariants;  //!< of the simulated corner
    std::vector<LabScore> cornerScores;   //!< one each
    Trajectory cornerTruth;

    /** The score of a variant, or nullptr when there is no such variant or the run failed. */
    [[nodiscard]] const LabScore* score(
        std::size_t sequence, const std::string& group, const std::string& name) const;

    /** Score as text, or "-" when there is no such variant or sequence. */
    [[nodiscard]] std::string text(
        std::size_t sequence, const std::string& group, const std::string& name) const;
};

/** Of the last position in the corner [m]. \param corner number of a scored variant */
[[nodiscard]] double finalError(const Reproduction& result, std::size_t corner);

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
