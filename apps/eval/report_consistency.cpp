// SPDX-License-Identifier: BSD-3-Clause
#include "report_consistency.h"

#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/trajectory_charts.h>

#include <cmath>
#include <string>
#include <vector>

#include "nees_output.h"
#include "result_output.h"

namespace pointplane
{
namespace
{
std::vector<std::string> consistencyCells(const std::string& name, const NeesResult& r)
{
    const ConsistencyTest& t = r.joint;
    const std::string judgement =
        t.isOptimistic() ? "optimistic, sigmas x " + numberText(std::sqrt(t.nees), 2) + " too small"
        : t.isConservative()
            ? "conservative, sigmas x " + numberText(1 / std::sqrt(t.nees), 2) + " too large"
            : shortVerdict(t);
    std::vector<std::string> cells{name, judgement, std::to_string(r.independent)};
    for (const ConsistencyTest& test : {r.joint, r.translation, r.rotation})
    {
        cells.push_back(numberText(test.nees, 2));
    }
    for (const AxisConsistency& axis : r.axes)
    {
        cells.push_back(numberText(axis.test.nees, 2));
    }
    cells.push_back(format("%.2f - %.2f", r.joint.lower, r.joint.upper));
    return cells;
}

const std::vector<std::string> kConsistencyColumns{
    "increments of",
    "verdict",
    "independent increments",
    "joint",
    "translation",
    "rotation",
    "x",
    "y",
    "z",
    "rx",
    "ry",
    "rz",
    "95 % bounds"};
}  // namespace

void addConsistency(HtmlReport& report, const ReportedRun& run)
{
    std::vector<std::vector<std::string>> rows;
    std::vector<Chart> charts;
    std::vector<Chart> errors;
    const NeesRun tested = neesRun(run.groundTruth, run.estimate, run.intervals, run.nees);
    for (const auto& [interval, increments] : tested.tested)
    {
        if (const std::string problem = problemOf(increments, interval); !problem.empty())
        {
            report.addParagraph("Note: left out: " + problem + ".");
            continue;
        }
        const auto result = consistencyOf(increments, countIndependent(increments), interval);
        rows.push_back(consistencyCells(describe(interval), result));
        charts.push_back(neesChart(run.estimate, increments, result));
        if (errors.empty())
        {
            errors = errorAgainstSigmaCharts(run.estimate, increments, interval);
        }
    }
    charts.insert(charts.end(), errors.begin(), errors.end());
    report.addTable(
        "NEES per degree of freedom (1 is consistent)",
        kConsistencyColumns,
        rows,
        "Ground truth with " + describeTruthNoise(run.nees) + ".");
    if (!tested.note.empty())
    {
        report.addParagraph("Note: " + tested.note + ".");
    }
    std::for_each(charts.begin(), charts.end(), [&](const Chart& c) { report.addChart(c); });
}
}  // namespace pointplane
