// SPDX-License-Identifier: BSD-3-Clause
#include "reproduce_tables.h"

#include <pointplane/evaluation/compare.h>
#include <pointplane/evaluation/units.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "result_output.h"

namespace pointplane
{
namespace
{
using Cells = std::vector<std::string>;

/** The paper's figures of a sequence; nothing but dashes if it has none. */
PublishedFigures publishedOf(const std::string& name)
{
    for (const PublishedFigures& figures : publishedFigures())
    {
        if (figures.sequence == name)
        {
            return figures;
        }
    }
    return {name, "", "", "", ""};
}

/** "12.3 / 0.45 (6 p)": mm and deg as in the paper's tables, and the frames that were predicted. */
std::string cellText(const LabScore& score)
{
    if (!score.rpe)
    {
        return "failed";
    }
    return format(
               "%.1f / %.2f",
               1000 * score.rpe->translation.rmse,
               kDegreesPerRadian * score.rpe->rotation.rmse) +
           (score.rpe->coverage.predicted > 0 ? format(" (%zu p)", score.rpe->coverage.predicted)
                                              : "");
}

const char* const kNotAtHand = "not at hand";
const char* const kNotInPaper = "not in the paper";

bool isAbsent(const Reproduction& result, const std::string& sequence)
{
    return std::none_of(
        result.sequences.begin(),
        result.sequences.end(),
        [&](const ReproducedSequence& s) { return s.name == sequence; });
}

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
                name = result.variants[v].name;
            }
        }
        best.push_back(name);
    }
    table.rows.push_back(std::move(best));
    return table;
}

/** Tables 1 and 2 of the paper, beside its figures: first its own sequences, then others. */
std::vector<ReproductionTable> paperTables(const Reproduction& result)
{
    ReproductionTable first{
        "Table 1: points, unweighted and weighted by their uncertainty (config-paper.ini)",
        {"sequence", "unweighted", "paper", "weighted", "paper"},
        {}};
    ReproductionTable second{
        "Table 2: points, and points and planes (config-paper.ini)",
        {"sequence", "points", "paper", "points and planes", "paper", "best named by the paper"},
        {}};
    const auto addRows = [&](const std::string& name, const PublishedFigures& p, const auto& ours)
    {
        const std::string points = ours("points");
        if (!p.deterministic.empty())
        {
            first.rows.push_back(
                {name, ours("points, unweighted"), p.deterministic, points, p.points});
        }
        second.rows.push_back(
            {name,
             points,
             p.points,
             ours("points and planes"),
             p.pointsAndPlanes,
             p.stateOfTheArt});
    };
    for (const PublishedFigures& p : publishedFigures())
    {
        if (isAbsent(result, p.sequence))
        {
            addRows(p.sequence, p, [](const char*) { return std::string(kNotAtHand); });
        }
    }
    for (std::size_t s = 0; s < result.sequences.size(); ++s)
    {
        PublishedFigures p = publishedOf(result.sequences[s].name);
        for (std::string* cell : {&p.points, &p.pointsAndPlanes, &p.stateOfTheArt})
        {
            *cell = cell->empty() ? kNotInPaper : *cell;
        }
        // structure_notexture_far and cabinet are in Table 2 only.
        p.deterministic = p.deterministic.empty() ? kNotInPaper : p.deterministic;
        addRows(
            displayName(result.sequences[s]),
            p,
            [&](const char* variant) { return result.text(s, "tables", variant); });
        if (p.deterministic == kNotInPaper)
        {
            first.rows.back().back() = kNotInPaper;
        }
    }
    return {first, second};
}

/** How much the error changes from one run of a sequence to another, "-8.2 [-16.4, -1.9] mm". */
std::string changeText(
    const Reproduction& result, std::size_t sequence, const char* from, const char* to)
{
    const LabScore* const a = result.score(sequence, "tables", from);
    const LabScore* const b = result.score(sequence, "tables", to);
    if (a == nullptr || b == nullptr)
    {
        return "-";
    }
    const Comparison both = compareRuns(
        result.truths[sequence], {a->estimate, b->estimate}, result.rpe, AteOptions(), {});
    const bool better = both.bestTranslation == 1;
    const auto& behind = both.runs[better ? 0 : 1].translationBehindBest;
    if (!behind)
    {
        return "-";
    }
    const double sign = better ? -1000 : 1000;
    const double ends[] = {sign * behind->lower, sign * behind->upper};
    return format(
        "%+.1f [%+.1f, %+.1f]%s",
        sign * behind->value,
        std::min(ends[0], ends[1]),
        std::max(ends[0], ends[1]),
        behind->excludesZero() ? "" : " chance");
}

ReproductionTable chanceTable(const Reproduction& result)
{
    ReproductionTable table{
        "Is it more than chance? Change of the error in mm, with its 95 % interval (bootstrap over "
        "blocks of 1 s)",
        {"sequence", "by weights, points alone", "by planes"},
        {}};
    for (std::size_t s = 0; s < result.sequences.size(); ++s)
    {
        table.rows.push_back(
            {displayName(result.sequences[s]),
             changeText(result, s, "points, unweighted", "points"),
             changeText(result, s, "points", "points and planes")});
    }
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
             score.rpe ? format("%.1f", 1000 * finalError(result, k)) : "failed",
             name == "planes" ? "114" : "-",
             cellText(score)});
    }
    return table;
}
}  // namespace

std::string displayName(const ReproducedSequence& s)
{
    return s.name + (s.isPart ? " (part)" : "");
}

const LabScore* Reproduction::score(
    std::size_t sequence, const std::string& group, const std::string& name) const
{
    for (std::size_t v = 0; v < variants.size(); ++v)
    {
        const LabScore& score = scores[sequence * variants.size() + v];
        if (variants[v].group == group && variants[v].name == name && score.rpe)
        {
            return &score;
        }
    }
    return nullptr;
}

std::string Reproduction::text(
    std::size_t sequence, const std::string& group, const std::string& name) const
{
    for (std::size_t v = 0; v < variants.size(); ++v)
    {
        if (variants[v].group == group && variants[v].name == name)
        {
            return cellText(scores[sequence * variants.size() + v]);
        }
    }
    return "-";
}

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
