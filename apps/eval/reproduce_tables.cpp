// SPDX-License-Identifier: BSD-3-Clause
#include "reproduce_tables.h"

#include <algorithm>

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

std::string orDash(const std::string& text) { return text.empty() ? "-" : text; }

bool hasGroup(const Reproduction& result, const std::string& group)
{
    return std::any_of(
        result.variants.begin(),
        result.variants.end(),
        [&](const Variant& v) { return v.group == group; });
}

/** Variants of a group down, sequences across. */
ReproductionTable groupTable(
    const Reproduction& result, const std::string& group, const std::string& caption)
{
    ReproductionTable table{caption, {group == "alpha" ? "alpha" : "configuration"}, {}};
    for (const ReproducedSequence& s : result.sequences)
    {
        table.header.push_back(displayName(s));
    }
    for (const Variant& v : result.variants)
    {
        if (v.group == group)
        {
            Cells row{v.name};
            for (std::size_t s = 0; s < result.sequences.size(); ++s)
            {
                row.push_back(result.text(s, group, v.name));
            }
            table.rows.push_back(std::move(row));
        }
    }
    return table;
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
            return scoreText(scores[sequence * variants.size() + v]);
        }
    }
    return "-";
}

std::vector<ReproductionTable> reproductionTables(const Reproduction& result)
{
    std::vector<ReproductionTable> out;
    if (hasGroup(result, "paper"))
    {
        ReproductionTable first{
            "Table 1: points, unweighted and weighted by their uncertainty (config-paper.ini)",
            {"sequence", "unweighted", "paper", "weighted", "paper"},
            {}};
        ReproductionTable second{
            "Table 2: points, and points and planes (config-paper.ini)",
            {"sequence",
             "points",
             "paper",
             "points and planes",
             "paper",
             "best named by the paper"},
            {}};
        for (std::size_t s = 0; s < result.sequences.size(); ++s)
        {
            const PublishedFigures p = publishedOf(result.sequences[s].name);
            const std::string name = displayName(result.sequences[s]);
            const std::string points = result.text(s, "paper", "points");
            first.rows.push_back(
                {name,
                 result.text(s, "paper", "points, unweighted"),
                 orDash(p.deterministic),
                 points,
                 orDash(p.deterministic.empty() ? "" : p.points)});
            second.rows.push_back(
                {name,
                 points,
                 orDash(p.points),
                 result.text(s, "paper", "points and planes"),
                 orDash(p.pointsAndPlanes),
                 orDash(p.stateOfTheArt)});
        }
        out.push_back(first);
        out.push_back(second);
    }
    if (hasGroup(result, "alpha"))
    {
        out.push_back(
            groupTable(result, "alpha", "Fig. 3: weight of the planes (config-paper.ini)"));
    }
    if (hasGroup(result, "paper"))
    {
        out.push_back(groupTable(result, "paper", "Ablations of config-paper.ini"));
    }
    if (hasGroup(result, "default"))
    {
        out.push_back(groupTable(result, "default", "Ablations of the default configuration"));
    }
    return out;
}
}  // namespace pointplane
