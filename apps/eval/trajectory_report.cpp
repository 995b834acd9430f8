// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_report.h"

#include <pointplane/core/number_text.h>
#include <pointplane/core/read_errors.h>
#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <ostream>
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

/** Of frames that have a pose, in order. */
std::vector<double> stampsOfPoses(const FrameTable& table)
{
    std::vector<double> out;
    for (std::size_t row = 0; row < table.size(); ++row)
    {
        if (table.status().empty() || table.status()[row] != "lost")
        {
            out.push_back(table.stamps()[row]);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

/** The first stamp, within the time of the others, that none of them is. Both are sorted. */
std::optional<double> firstMissing(
    const std::vector<double>& stamps, const std::vector<double>& others)
{
    constexpr double kSavedRounding = 1e-3;  // [s] of a table that a spreadsheet saved
    for (const double stamp : stamps)
    {
        const bool isWithin = stamp >= others.front() && stamp <= others.back();
        if (isWithin && std::abs(others[nearestIndex(others, stamp)] - stamp) > kSavedRounding)
        {
            return stamp;
        }
    }
    return {};
}

/** What the table says of another frame than the estimate; empty: nothing. It may be of a part.
 * \param poses the estimate's, without lost ones */
std::string differenceOf(const Trajectory& poses, const FrameTable& table)
{
    const std::vector<double> rows = stampsOfPoses(table);
    if (const auto stamp = firstMissing(poses.stamps, rows))
    {
        return "has no row that fits the pose at " + numberText(*stamp, 6) + " s of ";
    }
    if (!poses.marksFrames || table.status().empty())
    {
        return "";  // not of every frame
    }
    if (const auto stamp = firstMissing(rows, poses.stamps))
    {
        return "has a row at " + numberText(*stamp, 6) + " s, but there is no pose in ";
    }
    for (const auto& [pose, row] : rowsOf(poses.stamps, table))
    {
        const auto [first, end] = std::equal_range(rows.begin(), rows.end(), table.stamps()[row]);
        const bool isOneOfSeveral = end - first > 1;  // the clock was set back
        const bool isPredicted =
            !poses.status.empty() && poses.status[pose] == FrameStatus::Predicted;
        if (!isOneOfSeveral && isPredicted != (table.status()[row] == "predicted"))
        {
            return "says '" + table.status()[row] + "' of the frame at " +
                   numberText(poses.stamps[pose], 6) + " s, which is " +
                   (isPredicted ? "predicted" : "tracked") + " in ";
        }
    }
    return "";
}

/** \throws InputError if the table is not of the run that wrote the estimate */
void requireTableOf(
    const Trajectory& estimate,
    const FrameTable& table,
    const std::string& path,
    CommandContext& context)
{
    const Trajectory poses = withoutLost(estimate);
    const std::size_t numRows = rowsOf(poses.stamps, table).size();
    const std::string difference =
        numRows == 0 ? "has none of the stamps of " : differenceOf(poses, table);
    if (!difference.empty())
    {
        throw InputError(
            path + ": " + difference + estimate.name +
            "; give the table that --diagnostics wrote in the same run");
    }
    if (numRows < poses.size())
    {
        context.tell(
            "warning",
            path + ": has rows of " + std::to_string(numRows) + " of the " +
                std::to_string(poses.size()) + " poses of " + estimate.name);
    }
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

ReportInputs ReportOptions::read(const Trajectory& estimate, CommandContext& context) const
{
    ReportInputs out;
    if (!diagnostics.empty())
    {
        out.table = FrameTable::read(diagnostics);
        requireTableOf(estimate, out.table, diagnostics, context);
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
    const auto addNees = [&] { addSection(report, "NEES", [&] { addConsistency(report, run); }); };
    if (run.isOfNees)
    {
        addNees();
    }
    addPathSections(report, run);
    if (!run.isOfNees && !run.estimate.covs.empty())
    {
        addNees();
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
