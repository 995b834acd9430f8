// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_output.h"

#include <pointplane/evaluation/units.h>

#include <ostream>

#include "result_output.h"
#include "sweep_charts.h"

namespace pointplane
{
void printTable(const SweepResult& sweep, std::ostream& out)
{
    out << "Sweep of " << sweep.parameter << ", RPE RMSE: " << sweep.protocol << "\n\n"
        << format("%-16s", "value");
    for (const std::string& name : shownNames(sweep.sequences, 26))
    {
        out << "  " << name;
    }
    out << "\n";
    for (std::size_t v = 0; v < sweep.values.size(); ++v)
    {
        out << format("%-16s", sweep.values[v].c_str());
        for (std::size_t s = 0; s < sweep.sequences.size(); ++s)
        {
            out << format("  %-26s", scoreText(sweep.at(s, v)).c_str());
        }
        out << "\n";
    }
}

nlohmann::ordered_json toJson(const SweepResult& sweep)
{
    nlohmann::ordered_json json;
    json["title"] = "Sweep of " + sweep.parameter;
    json["protocol"] = sweep.protocol;
    for (std::size_t s = 0; s < sweep.sequences.size(); ++s)
    {
        for (std::size_t v = 0; v < sweep.values.size(); ++v)
        {
            nlohmann::ordered_json item{
                {"sequence", sweep.sequences[s]}, {"value", sweep.values[v]}};
            addScore(sweep.at(s, v), item);
            json["runs"].push_back(item);
        }
    }
    return json;
}

std::string toCsv(const SweepResult& sweep)
{
    std::string out = std::string("sequence,parameter,value,") + kScoreColumns;
    for (std::size_t s = 0; s < sweep.sequences.size(); ++s)
    {
        for (std::size_t v = 0; v < sweep.values.size(); ++v)
        {
            out += csvField(sweep.sequences[s]) + "," + sweep.parameter + "," +
                   csvField(sweep.values[v]) + "," + scoreFields(sweep.at(s, v));
        }
    }
    return out;
}

HtmlReport reportOf(const SweepResult& sweep, bool logarithmic)
{
    HtmlReport report("Sweep of " + sweep.parameter, sweep.protocol);
    std::vector<Chart> charts = sweepCharts(
        sweep.parameter,
        sweep.values,
        sweep.sequences,
        sweep.scores,
        logarithmic ? ValueAxis::Log : ValueAxis::Linear);
    for (const Chart& chart : charts)
    {
        report.addChart(chart);
    }
    std::vector<std::vector<std::string>> rows;
    std::vector<std::string> header{sweep.parameter};
    header.insert(header.end(), sweep.sequences.begin(), sweep.sequences.end());
    for (std::size_t v = 0; v < sweep.values.size(); ++v)
    {
        rows.push_back({sweep.values[v]});
        for (std::size_t s = 0; s < sweep.sequences.size(); ++s)
        {
            rows.back().push_back(scoreText(sweep.at(s, v)));
        }
    }
    report.addTable("RPE RMSE", header, rows);
    return report;
}
}  // namespace pointplane
