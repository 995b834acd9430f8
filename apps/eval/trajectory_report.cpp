// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_report.h"

#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/mrpt_io/errors.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "OutputGuard.h"
#include "command.h"
#include "report_consistency.h"
#include "report_file.h"
#include "report_paths.h"
#include "report_section.h"
#include "report_worst_frames.h"

namespace pointplane
{
namespace
{
std::string textOf(const std::string& path)
{
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path))
    {
        throw InputError(
            "cannot open " + path + ": " + (file ? "is a directory" : std::strerror(errno)));
    }
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}
}  // namespace

void ReportOptions::addTo(CLI::App& command)
{
    CLI::Option* report = command.add_option(
        "--report", directory, "Write DIR/index.html, with charts, and each chart as SVG");
    report->type_name("DIR")->group("Output");
    const auto addPart =
        [&](const char* name, std::string& path, const char* type, const char* description) {
            command.add_option(name, path, description)
                ->type_name(type)
                ->needs(report)
                ->group("Output");
        };
    addPart("--diagnostics", diagnostics, "FILE", "Table of pointplane-odometry --diagnostics");
    addPart("--run-config", runConfig, "FILE", "Configuration of the run, to be shown");
    addPart("--overlays", overlays, "DIR", "Folder of pointplane-odometry --overlay");
}

void ReportOptions::guardedBy(OutputGuard& guard) const
{
    guard.addInput(diagnostics);
    guard.addInput(runConfig);
    guardReport(guard, directory);
}

void writeTrajectoryReport(
    const ReportedRun& run, const ReportOptions& options, CommandContext& context)
{
    HtmlReport report(
        std::filesystem::path(run.estimate.name).filename().string(),
        "estimate " + run.estimate.name + ", ground truth " + run.groundTruth.name);
    if (!run.hint.empty())
    {
        report.addParagraph("Hint: " + run.hint);
    }
    addPathSections(report, run);
    if (!run.estimate.covs.empty())
    {
        addSection(report, "NEES", [&] { addConsistency(report, run); });
    }
    FrameTable table;
    if (!options.diagnostics.empty())
    {
        table = FrameTable::read(options.diagnostics);
        for (const Chart& chart : frameCharts(table))
        {
            report.addChart(chart);
        }
    }
    if (!options.overlays.empty())
    {
        addWorstFrames(report, run, table, options.overlays);
    }
    if (!options.runConfig.empty())
    {
        report.addDetails(
            "Configuration of the run: " + options.runConfig, textOf(options.runConfig));
    }
    writeReportFile(std::move(report), options.directory, context);
}
}  // namespace pointplane
