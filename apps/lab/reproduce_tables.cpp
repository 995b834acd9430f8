// SPDX-License-Identifier: BSD-3-Clause
#include "reproduce_tables.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "paper_comparison.h"
#include "result_output.h"

namespace pointplane
{
namespace
{
using Cells = std::vector<std::string>;

bool hasGroup(const Reproduction& result, const std::string& group)
{
    return std::any_of(
        result.variants.begin(),
        result.variants.end(),
        [&](const Variant& v) { return v.group == group; });
}

/** Variants of some groups down, sequences across. */
ReproductionTable groupTable(
    const Reproduction& result,
    const std::string& caption,
    const std::string& what,
    const std::vector<std::string>& groups)
{
    ReproductionTable table{caption, {what}, {}};
    for (const ReproducedSequence& s : result.sequences)
    {
        table.header.push_back(displayName(s));
    }
    for (const Variant& v : result.variants)
    {
        if (std::find(groups.begin(), groups.end(), v.group) != groups.end())
        {
            Cells row{v.name};
            for (std::size_t s = 0; s < result.sequences.size(); ++s)
            {
                row.push_back(result.text(s, v.group, v.name));
            }
            table.rows.push_back(std::move(row));
        }
    }
    return table;
}

/** Fig. 3 as a table, and for each sequence the alpha with the smallest error. */
ReproductionTable alphaTable(const Reproduction& result)
{
    ReproductionTable table = groupTable(
        result,
        "Fig. 3: weight of the planes (config-paper.ini). The paper draws curves and takes alpha = "
        "10; with plane weights in metres, that is 1e7 here",
        "alpha",
        {"alpha"});
    Cells best{"smallest mm at"};
    for (std::size_t s = 0; s < result.sequences.size(); ++s)
    {
        std::string name = "-";
        double smallest = std::numeric_limits<double>::infinity();
        for (std::size_t v = 0; v < result.variants.size(); ++v)
        {
            const auto& rpe = result.scores[s * result.variants.size() + v].rpe;
            if (result.variants[v].group == "alpha" && rpe && rpe->translation.rmse < smallest)
            {
                smallest = rpe->translation.rmse;
                name = result.variants[v].name +
                       unmeasuredText(result.scores[s * result.variants.size() + v], kShortWords);
            }
        }
        best.push_back(name);
    }
    table.rows.push_back(std::move(best));
    return table;
}

/** How many frames a run of the sequence had: colour images with a depth image. */
std::string framesText(const Reproduction& result, std::size_t sequence)
{
    const std::size_t runs = result.variants.size();
    for (std::size_t v = 0; v < runs; ++v)
    {
        if (const auto& rpe = result.scores[sequence * runs + v].rpe)
        {
            const Coverage& coverage = rpe->coverage;
            return std::to_string(coverage.tracked + coverage.predicted + coverage.lost);
        }
    }
    return "-";
}

ReproductionTable sequenceTable(const Reproduction& result)
{
    ReproductionTable table{
        "Sequences",
        {"sequence",
         "first stamp",
         "last stamp",
         "colour images",
         "frames",
         "in the paper",
         "chosen on a part of it"},
        {}};
    for (std::size_t k = 0; k < result.sequences.size(); ++k)
    {
        const ReproducedSequence& s = result.sequences[k];
        table.rows.push_back(
            {displayName(s),
             s.firstStamp,
             s.lastStamp,
             std::to_string(s.numFrames),
             framesText(result, k),
             publishedOf(s.name).points.empty() ? "no" : "yes",
             chosenOn(s.name)});
    }
    return table;
}

/** The error, and when it was the last one if the run ended before the recording. */
std::string finalErrorText(const Reproduction& result, std::size_t corner)
{
    const LabScore& score = result.cornerScores[corner];
    if (!score.rpe)
    {
        return "failed";
    }
    const std::string error = format("%.1f", 1000 * finalError(result, corner));
    const Trajectory& estimate = score.estimate;
    const double end = estimate.lostStamps.empty() ? 0 : estimate.lostStamps.back();
    const double start = result.cornerTruth.stamps.front();
    return estimate.stamps.back() < end
               ? error +
                     format(
                         ", lost from %.1f to %.1f s", estimate.stamps.back() - start, end - start)
               : error;
}

ReproductionTable cornerTable(const Reproduction& result)
{
    ReproductionTable table{
        "Fig. 5: a room corner (config-paper.ini). Theirs was real, ours is simulated; the paper's "
        "final error is that of the planes",
        {"features", "final error of the position, mm", "paper", "RPE"},
        {}};
    for (std::size_t k = 0; k < result.cornerVariants.size(); ++k)
    {
        const std::string& name = result.cornerVariants[k].name;
        const LabScore& score = result.cornerScores[k];
        table.rows.push_back(
            {name,
             finalErrorText(result, k),
             name == "planes" ? "114" : "-",
             scoreText(score, kShortWords)});
    }
    return table;
}
}  // namespace

std::vector<ReproductionTable> reproductionTables(const Reproduction& result)
{
    std::vector<ReproductionTable> out{sequenceTable(result)};
    if (hasGroup(result, "tables"))
    {
        for (ReproductionTable& table : paperTables(result))
        {
            out.push_back(std::move(table));
        }
        out.push_back(chanceTable(result));
    }
    const auto addGroup = [&](const char* group, const char* caption, const char* what)
    {
        if (hasGroup(result, group))
        {
            out.push_back(groupTable(result, caption, what, {group}));
        }
    };
    addGroup(
        "tukey",
        "Table 1 by the constant of Tukey's function, which the paper does not name "
        "(config-paper.ini has the usual 4.685; 0 = no M-estimator)",
        "features, robust sigmas");
    if (hasGroup(result, "alpha"))
    {
        out.push_back(alphaTable(result));
    }
    if (!result.cornerVariants.empty())
    {
        out.push_back(cornerTable(result));
    }
    addGroup("paper", "Ablations of config-paper.ini", "configuration");
    addGroup("detectors", "Detectors (config-paper.ini)", "configuration");
    return out;
}
}  // namespace pointplane
