// SPDX-License-Identifier: BSD-3-Clause
#include "reproduce_output.h"

#include <pointplane/evaluation/units.h>

#include <algorithm>

#include "PosesFromStart.h"
#include "reproduce_tables.h"
#include "result_output.h"
#include "sweep_charts.h"

namespace pointplane
{
namespace
{
/** What the paper evaluates and this folder does not hold, or holds only a part of. */
std::string missing(const Reproduction& result)
{
    std::string absent;
    std::string parts;
    for (const PublishedFigures& figures : publishedFigures())
    {
        const auto found = std::find_if(
            result.sequences.begin(),
            result.sequences.end(),
            [&](const ReproducedSequence& s) { return s.name == figures.sequence; });
        std::string& list = found == result.sequences.end() ? absent : parts;
        if (found == result.sequences.end() || found->isPart)
        {
            list += (list.empty() ? "" : ", ") + figures.sequence;
        }
    }
    std::string out;
    out += absent.empty() ? "" : "Missing of the paper's sequences: " + absent + ". ";
    out += parts.empty()
               ? ""
               : "Only a part, so not comparable with the published figure as it stands: " + parts +
                     ". ";
    return out;
}

std::string failures(const Reproduction& result)
{
    std::string out;
    for (std::size_t k = 0; k < result.scores.size(); ++k)
    {
        if (!result.scores[k].rpe)
        {
            const Variant& v = result.variants[k % result.variants.size()];
            out += "- " + displayName(result.sequences[k / result.variants.size()]) + ", " +
                   v.group + ", " + v.name + ": " + result.scores[k].failure + "\n";
        }
    }
    for (std::size_t k = 0; k < result.cornerScores.size(); ++k)
    {
        if (!result.cornerScores[k].rpe)
        {
            out += "- corner, " + result.cornerVariants[k].name + ": " +
                   result.cornerScores[k].failure + "\n";
        }
    }
    return out;
}

std::string intro(const Reproduction& result)
{
    return "RMSE of the relative pose error in mm / deg. " + describe(result.rpe) +
           ". n l: n frames were lost. n p: n frames were predicted, not measured.";
}

nlohmann::ordered_json runJson(
    const ReproducedSequence& sequence, const Variant& variant, const LabScore& score)
{
    nlohmann::ordered_json run{
        {"sequence", sequence.name},
        {"part", sequence.isPart},
        {"group", variant.group},
        {"variant", variant.name},
        {"config", variant.config},
        {"settings", variant.settings}};
    addScore(score, run);
    return run;
}

nlohmann::ordered_json cornerJson(const Reproduction& result, std::size_t k)
{
    const Variant& variant = result.cornerVariants[k];
    const LabScore& score = result.cornerScores[k];
    nlohmann::ordered_json run{{"variant", variant.name}, {"settings", variant.settings}};
    addScore(score, run);
    if (score.rpe)
    {
        run["finalError"] = finalError(result, k);
        run["finalTime"] = score.estimate.stamps.back() - result.cornerTruth.stamps.front();
    }
    return run;
}
}  // namespace

std::string toMarkdown(const Reproduction& result)
{
    std::string out = intro(result) + "\n";
    for (const ReproductionTable& table : reproductionTables(result))
    {
        std::vector<std::size_t> widths;
        for (std::size_t c = 0; c < table.header.size(); ++c)
        {
            widths.push_back(table.header[c].size());
            for (const auto& row : table.rows)
            {
                widths[c] = std::max(widths[c], row[c].size());
            }
        }
        const auto line = [&](const std::vector<std::string>& cells)
        {
            std::string text = "|";
            for (std::size_t c = 0; c < cells.size(); ++c)
            {
                text += " " + cells[c] + std::string(widths[c] - cells[c].size(), ' ') + " |";
            }
            return text + "\n";
        };
        std::vector<std::string> rule;
        for (const std::size_t width : widths)
        {
            rule.push_back(std::string(width, '-'));
        }
        out += "\n### " + table.caption + "\n\n" + line(table.header) + line(rule);
        for (const auto& row : table.rows)
        {
            out += line(row);
        }
    }
    const std::string absent = missing(result);
    out += absent.empty() ? "" : "\n" + absent + "\n";
    const std::string failed = failures(result);
    return out + (failed.empty() ? "" : "\nFailed runs:\n" + failed);
}

nlohmann::ordered_json toJson(const Reproduction& result)
{
    nlohmann::ordered_json json;
    json["title"] = "Reproduction";
    json["protocol"] = describe(result.rpe);
    json["missing"] = missing(result);
    for (const PublishedFigures& p : publishedFigures())
    {
        json["published"].push_back(
            {{"sequence", p.sequence},
             {"pointsUnweighted", p.deterministic},
             {"points", p.points},
             {"pointsAndPlanes", p.pointsAndPlanes},
             {"bestNamedByThePaper", p.stateOfTheArt}});
    }
    for (std::size_t k = 0; k < result.scores.size(); ++k)
    {
        json["runs"].push_back(runJson(
            result.sequences[k / result.variants.size()],
            result.variants[k % result.variants.size()],
            result.scores[k]));
    }
    for (std::size_t k = 0; k < result.cornerScores.size(); ++k)
    {
        json["corner"].push_back(cornerJson(result, k));
    }
    return json;
}

std::string toCsv(const Reproduction& result)
{
    std::string out = std::string("sequence,part,group,variant,") + kScoreColumns;
    for (std::size_t k = 0; k < result.scores.size(); ++k)
    {
        const ReproducedSequence& s = result.sequences[k / result.variants.size()];
        const Variant& v = result.variants[k % result.variants.size()];
        out += csvField(s.name) + "," + (s.isPart ? "1" : "0") + "," + v.group + "," +
               csvField(v.name) + "," + scoreFields(result.scores[k]);
    }
    return out;
}

namespace
{
std::vector<Chart> alphaCharts(const Reproduction& result)
{
    std::vector<std::string> alphas;
    std::vector<std::string> names;
    std::vector<LabScore> scores;
    for (std::size_t s = 0; s < result.sequences.size(); ++s)
    {
        names.push_back(displayName(result.sequences[s]));
        for (std::size_t v = 0; v < result.variants.size(); ++v)
        {
            if (result.variants[v].group == "alpha")
            {
                scores.push_back(result.scores[s * result.variants.size() + v]);
                if (s == 0)
                {
                    alphas.push_back(result.variants[v].name);
                }
            }
        }
    }
    if (alphas.empty())
    {
        return {};
    }
    std::vector<Chart> charts = sweepCharts("alpha", alphas, names, scores, ValueAxis::Names);
    for (Chart& chart : charts)
    {
        chart.title = "Fig. 3: " + chart.title;
        chart.yFromZero = false;
        chart.logY = true;
    }
    return charts;
}
}  // namespace

std::vector<NamedChart> figuresOf(const Reproduction& result)
{
    std::vector<NamedChart> out;
    const auto add = [&](const std::string& fileName, const std::vector<Chart>& charts)
    {
        const char* const names[] = {"translation", "rotation"};
        for (std::size_t k = 0; k < charts.size(); ++k)
        {
            out.push_back({fileName + names[k] + ".svg", charts[k]});
        }
    };
    add("paper_fig3_", alphaCharts(result));
    for (std::size_t k = 0; k < result.cornerScores.size(); ++k)
    {
        if (result.cornerScores[k].rpe)
        {
            const std::string& name = result.cornerVariants[k].name;
            std::string asFile = name;
            std::replace(asFile.begin(), asFile.end(), ' ', '_');
            add("paper_fig5_" + asFile + "_",
                PosesFromStart(result.cornerTruth, result.cornerScores[k].estimate).charts(name));
        }
    }
    return out;
}

HtmlReport reportOf(const Reproduction& result)
{
    HtmlReport report("Reproduction of the paper's figures", intro(result));
    const std::string absent = missing(result);
    if (!absent.empty())
    {
        report.addParagraph(absent);
    }
    for (const NamedChart& figure : figuresOf(result))
    {
        report.addChart(figure.chart);
    }
    for (const ReproductionTable& table : reproductionTables(result))
    {
        report.addTable(table.caption, table.header, table.rows);
    }
    return report;
}
}  // namespace pointplane
