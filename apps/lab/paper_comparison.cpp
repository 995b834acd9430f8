// SPDX-License-Identifier: BSD-3-Clause
#include "paper_comparison.h"

#include <pointplane/evaluation/compare.h>

#include <algorithm>

#include "result_output.h"

namespace pointplane
{
namespace
{
const char* const kNotAtHand = "not at hand";
const char* const kNotInPaper = "-";

bool isAbsent(const Reproduction& result, const std::string& sequence)
{
    return std::none_of(
        result.sequences.begin(),
        result.sequences.end(),
        [&](const ReproducedSequence& s) { return s.name == sequence; });
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
    if (!behind->isKnown())
    {
        return format("%+.1f too short", sign * behind->value);
    }
    const double ends[] = {sign * behind->lower, sign * behind->upper};
    return format(
        "%+.1f [%+.1f, %+.1f]%s",
        sign * behind->value,
        std::min(ends[0], ends[1]),
        std::max(ends[0], ends[1]),
        behind->excludesZero() ? "" : " chance");
}

/** The paper's Tables 1 and 2, with our figures beside its own. */
struct PaperTables
{
    ReproductionTable first{
        "Table 1: points, unweighted and weighted by their uncertainty (config-paper.ini)",
        {"sequence", "unweighted", "paper", "weighted", "paper"},
        {}};
    ReproductionTable second{
        "Table 2: points, and points and planes (config-paper.ini)",
        {"sequence", "points", "paper", "points and planes", "paper", "best named by the paper"},
        {}};

    /** Adds a sequence. \param ours(variant) our figures */
    template <class Ours>
    void add(const std::string& name, const PublishedFigures& p, const Ours& ours)
    {
        const std::string points = ours("points");
        if (!p.deterministic.empty())
        {
            // structure_notexture_far and cabinet are in Table 2 only.
            const bool isInFirst = p.deterministic != kNotInPaper;
            first.rows.push_back(
                {name,
                 ours("points, unweighted"),
                 p.deterministic,
                 points,
                 isInFirst ? p.points : kNotInPaper});
        }
        second.rows.push_back(
            {name,
             points,
             p.points,
             ours("points and planes"),
             p.pointsAndPlanes,
             p.stateOfTheArt});
    }
};

/** With a dash where the paper has no figure. */
PublishedFigures withoutGaps(PublishedFigures p)
{
    for (std::string* cell : {&p.deterministic, &p.points, &p.pointsAndPlanes, &p.stateOfTheArt})
    {
        *cell = cell->empty() ? kNotInPaper : *cell;
    }
    return p;
}
}  // namespace

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

std::vector<ReproductionTable> paperTables(const Reproduction& result)
{
    PaperTables tables;
    for (const PublishedFigures& p : publishedFigures())
    {
        if (isAbsent(result, p.sequence))
        {
            tables.add(p.sequence, p, [](const char*) { return std::string(kNotAtHand); });
        }
    }
    for (std::size_t s = 0; s < result.sequences.size(); ++s)
    {
        tables.add(
            displayName(result.sequences[s]),
            withoutGaps(publishedOf(result.sequences[s].name)),
            [&](const char* variant) { return result.text(s, "tables", variant); });
    }
    return {tables.first, tables.second};
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
}  // namespace pointplane
