// SPDX-License-Identifier: BSD-3-Clause
#include "reproduce_tables.h"

#include <pointplane/evaluation/units.h>

#include <algorithm>
#include <limits>

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

/** "12.3 / 0.45": mm and deg, as in the paper's tables. */
std::string cellText(const OdometryScore& score)
{
    return score.rpe ? format(
                           "%.1f / %.2f",
                           1000 * score.rpe->translation.rmse,
                           kDegreesPerRadian * score.rpe->rotation.rmse)
                     : "failed";
}

std::string orDash(const std::string& text) { return text.empty() ? "-" : text; }

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
        "Fig. 3: weight of the planes (config-paper.ini). The paper draws curves without figures "
        "and takes alpha = 10",
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

/** Tables 1 and 2 of the paper, beside its figures. */
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
    for (std::size_t s = 0; s < result.sequences.size(); ++s)
    {
        const PublishedFigures p = publishedOf(result.sequences[s].name);
        const std::string name = displayName(result.sequences[s]);
        const std::string points = result.text(s, "tables", "points");
        first.rows.push_back(
            {name,
             result.text(s, "tables", "points, unweighted"),
             orDash(p.deterministic),
             points,
             orDash(p.deterministic.empty() ? "" : p.points)});
        second.rows.push_back(
            {name,
             points,
             orDash(p.points),
             result.text(s, "tables", "points and planes"),
             orDash(p.pointsAndPlanes),
             orDash(p.stateOfTheArt)});
    }
    const std::string absent = "not here";
    for (const PublishedFigures& p : publishedFigures())
    {
        if (isAbsent(result, p.sequence))
        {
            if (!p.deterministic.empty())
            {
                first.rows.push_back({p.sequence, absent, p.deterministic, absent, p.points});
            }
            second.rows.push_back(
                {p.sequence, absent, p.points, absent, p.pointsAndPlanes, p.stateOfTheArt});
        }
    }
    return {first, second};
}
}  // namespace

std::string displayName(const ReproducedSequence& s)
{
    return s.name + (s.isPart ? " (part)" : "");
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
    std::vector<ReproductionTable> out;
    if (hasGroup(result, "tables"))
    {
        out = paperTables(result);
    }
    if (hasGroup(result, "alpha"))
    {
        out.push_back(alphaTable(result));
    }
    if (hasGroup(result, "paper"))
    {
        out.push_back(groupTable(
            result, "Ablations of config-paper.ini", "configuration", {"tables", "paper"}));
    }
    if (hasGroup(result, "default"))
    {
        out.push_back(groupTable(
            result, "Ablations of the default configuration", "configuration", {"default"}));
    }
    return out;
}
}  // namespace pointplane
