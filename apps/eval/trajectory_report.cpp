// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_report.h"

#include <pointplane/core/read_errors.h>
#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
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
bool isText(const std::string& bytes)
{
    const auto isControl = [](char c)
    { return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t'; };
    return std::none_of(bytes.begin(), bytes.end(), isControl);
}

/** \throws InputError if it is not that of a configuration, which would fill the page */
std::string textOf(const std::string& path)
{
    constexpr std::size_t kLongest = 1 << 20;
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path))
    {
        throw InputError(
            "cannot open " + path + ": " + (file ? "is a directory" : std::strerror(errno)));
    }
    std::string text(kLongest + 1, ' ');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    requireRead(file, path);
    text.resize(static_cast<std::size_t>(file.gcount()));
    if (!isText(text) || text.size() > kLongest)
    {
        throw InputError(
            path + (isText(text) ? ": is longer than 1 MiB" : ": is not text") +
            "; give the configuration of the run");
    }
    return text;
}
}  // namespace

void ReportOptions::addTo(CLI::App& command)
{
    CLI::Option* const report = command.add_option(
        "--report", directory, "Write DIR/index.html, with charts, and each chart as SVG");
    report->type_name("DIR")->group("Output");
    const auto addPart = [&](const char* name,
                             std::string& path,
                             const char* type,
                             const char* description,
                             CLI::Option* needed)
    {
        CLI::Option* const part = command.add_option(name, path, description);
        return part->type_name(type)->needs(needed)->group("Output");
    };
    CLI::Option* const table = addPart(
        "--diagnostics", diagnostics, "FILE", "Table of pointplane-odometry --diagnostics", report);
    addPart("--run-config", runConfig, "FILE", "Configuration of the run, to be shown", report);
    // Only the table tells the numbers of frames.
    addPart("--overlays", overlays, "DIR", "Folder of pointplane-odometry --overlay", table);
}

void ReportOptions::guardedBy(OutputGuard& guard) const
{
    guard.addInput(diagnostics);
    guard.addInput(runConfig);
    guardReport(guard, directory);
}

ReportInputs ReportOptions::read(const Trajectory& estimate) const
{
    ReportInputs out;
    if (!diagnostics.empty())
    {
        out.table = FrameTable::read(diagnostics);
        if (rowsOf(estimate.stamps, out.table).empty())
        {
            throw InputError(
                diagnostics + ": has none of the stamps of " + estimate.name +
                "; give the table that --diagnostics wrote in the same run");
        }
    }
    if (!overlays.empty())
    {
        out.pictures = picturesOf(estimate, out.table, diagnostics, overlays);
    }
    if (!runConfig.empty())
    {
        out.runConfig = textOf(runConfig);
    }
    return out;
}

void writeTrajectoryReport(
    const ReportedRun& run,
    const ReportOptions& options,
    const ReportInputs& inputs,
    CommandContext& context)
{
    if (options.directory.empty())
    {
        return;
    }
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
    for (const Chart& chart : frameCharts(inputs.table, run.estimate.stamps.front()))
    {
        report.addChart(chart);
    }
    if (!options.overlays.empty())
    {
        addSection(
            report,
            "pictures of the worst frames",
            [&] { addWorstFrames(report, run, inputs.pictures); });
    }
    if (!options.runConfig.empty())
    {
        report.addDetails("Configuration of the run: " + options.runConfig, inputs.runConfig);
    }
    writeReportFile(std::move(report), options.directory, context);
}
}  // namespace pointplane
