// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_report.h"

#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/evaluation/units.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "nees_output.h"
#include "result_output.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kWorstFrames = 4;

std::vector<std::string> statisticsCells(const std::string& name, const Statistics& s)
{
    std::vector<std::string> cells{name};
    for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max})
    {
        cells.push_back(format("%.4f", value));
    }
    return cells;
}

void addScores(
    HtmlReport& report, const ReportedRun& run, const RpeResult& rpe, const AteResult& ate)
{
    const std::vector<std::string> header{"", "rmse", "mean", "median", "std", "min", "max"};
    report.addTable(
        "Relative pose error: " + describe(run.rpe, rpe),
        header,
        {statisticsCells("translation [mm]", scaled(rpe.translation, 1000)),
         statisticsCells("rotation [deg]", scaled(rpe.rotation, kDegreesPerRadian))});
    report.addTable(
        "Absolute trajectory error: " + describe(AteOptions(), ate, run.estimate.size()),
        header,
        {statisticsCells("translation [mm]", scaled(ate.translation, 1000))});
}

std::vector<std::string> consistencyCells(const std::string& name, const NeesResult& r)
{
    const ConsistencyTest& t = r.joint;
    const std::string judgement =
        t.isOptimistic() ? format("optimistic, sigmas x %.2f too small", std::sqrt(t.nees))
        : t.isConservative()
            ? format("conservative, sigmas x %.2f too large", 1 / std::sqrt(t.nees))
            : "consistent";
    std::vector<std::string> cells{name, judgement, std::to_string(r.independent)};
    for (const ConsistencyTest& test : {r.joint, r.translation, r.rotation})
    {
        cells.push_back(format("%.2f", test.nees));
    }
    for (const AxisConsistency& axis : r.axes)
    {
        cells.push_back(format("%.2f", axis.test.nees));
    }
    cells.push_back(format("%.2f - %.2f", r.joint.lower, r.joint.upper));
    return cells;
}

/** NEES table and charts; the charts of single errors for the first interval only.
 * \throws std::runtime_error where there is no NEES */
void addConsistency(HtmlReport& report, const ReportedRun& run)
{
    std::vector<std::vector<std::string>> rows;
    std::vector<Chart> charts;
    std::vector<Chart> errors;
    std::string note;
    for (const NeesInterval& interval : run.intervals)
    {
        const auto increments = neesIncrements(run.groundTruth, run.estimate, interval, run.nees);
        const auto result = consistencyOf(increments, countIndependent(increments), interval);
        rows.push_back(consistencyCells(nameOf(interval), result));
        note = note.empty() ? noteOnUntold(run.estimate, increments) : note;
        charts.push_back(neesChart(run.estimate, increments, result));
        if (errors.empty())
        {
            errors = errorAgainstSigmaCharts(run.estimate, increments);
        }
    }
    charts.insert(charts.end(), errors.begin(), errors.end());
    report.addTable(
        "NEES per degree of freedom (1 is consistent), ground truth with " +
            describeTruthNoise(run.nees),
        {"increments of",
         "verdict",
         "independent",
         "joint",
         "translation",
         "rotation",
         "x",
         "y",
         "z",
         "rx",
         "ry",
         "rz",
         "95 % bounds"},
        rows);
    if (!note.empty())
    {
        report.addParagraph(note);
    }
    std::for_each(charts.begin(), charts.end(), [&](const Chart& c) { report.addChart(c); });
}

/** Number that pointplane-odometry gave a frame: the table knows, else it is the pose's index. */
std::size_t frameNumber(const FrameTable& table, double stamp, std::size_t index)
{
    const std::vector<double> frames = table.column("frame");
    if (frames.empty())
    {
        return index;
    }
    return static_cast<std::size_t>(frames[nearestIndex(table.stamps(), stamp)]);
}

/** Pictures of the frames whose motion from the previous frame is the most wrong. */
void addWorstFrames(
    HtmlReport& report,
    const ReportedRun& run,
    const Trajectory& truth,
    const FrameTable& table,
    const std::string& folder)
{
    RpeOptions frameToFrame = run.rpe;
    frameToFrame.fixedDelta = true;
    frameToFrame.delta = 1;
    frameToFrame.unit = DeltaUnit::Frames;
    frameToFrame.truthAt = TruthAt::Interpolated;
    std::vector<RpePair> pairs = relativePoseError(truth, run.estimate, frameToFrame).pairs;
    std::sort(
        pairs.begin(),
        pairs.end(),
        [](const RpePair& a, const RpePair& b) { return a.translation > b.translation; });
    pairs.resize(std::min(pairs.size(), kWorstFrames));
    for (const RpePair& pair : pairs)
    {
        const double stamp = run.estimate.stamps[pair.j];
        const std::size_t frame = frameNumber(table, stamp, pair.j);
        report.addPicture(
            format(
                "Frame %zu at %.2f s: motion off by %.1f mm, %.2f deg",
                frame,
                stamp - run.estimate.stamps.front(),
                1000 * pair.translation,
                kDegreesPerRadian * pair.rotation),
            folder + format("/%06zu.png", frame));
    }
}
}  // namespace

void ReportOptions::addTo(CLI::App& command)
{
    command.add_option("--report", directory, "Write DIR/index.html: one file, with charts")
        ->type_name("DIR")
        ->group("Output");
    command
        .add_option(
            "--diagnostics",
            diagnostics,
            "For the report: table of pointplane-odometry --diagnostics")
        ->type_name("FILE")
        ->group("Output");
    command
        .add_option(
            "--overlays", overlays, "For the report: folder of pointplane-odometry --overlay")
        ->type_name("DIR")
        ->group("Output");
}

std::string writeReportFile(const std::string& html, const std::string& directory)
{
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    const std::string path = directory + "/index.html";
    std::ofstream file(path);
    file << html;
    file.close();
    if (!file)
    {
        throw EnvironmentError("cannot write '" + path + "'");
    }
    return path;
}

std::string writeTrajectoryReport(const ReportedRun& run, const ReportOptions& options)
{
    const Trajectory truth = withBody(run.groundTruth, run.nees.T_truth_body);
    RpeOptions rpeOptions = run.rpe;
    rpeOptions.fixedDelta = true;
    const RpeResult rpe = relativePoseError(truth, run.estimate, rpeOptions);
    AteOptions ateOptions;
    ateOptions.offset = run.rpe.offset;
    ateOptions.scale = run.rpe.scale;
    const AteResult ate = absoluteTrajectoryError(truth, run.estimate, ateOptions);
    // Covariances are relative to the first pose, so that is where ellipses start from.
    AteOptions forMap = ateOptions;
    forMap.alignment = run.estimate.covs.empty() ? Alignment::Se3 : Alignment::FirstPose;

    HtmlReport report(
        std::filesystem::path(run.estimate.name).filename().string(),
        "estimate " + run.estimate.name + ", ground truth " + run.groundTruth.name);
    ReportedRun scored = run;
    scored.rpe = rpeOptions;
    addScores(report, scored, rpe, ate);
    const AteResult mapAte = absoluteTrajectoryError(truth, run.estimate, forMap);
    for (const Chart& chart : pathCharts(truth, run.estimate, mapAte))
    {
        report.addChart(chart);
    }
    report.addChart(relativeErrorChart(run.estimate, rpeOptions, rpe));
    report.addChart(positionErrorChart(run.estimate, ate));
    if (!run.estimate.covs.empty())
    {
        try
        {
            addConsistency(report, run);
        }
        catch (const std::runtime_error& error)
        {
            report.addParagraph("No NEES: " + std::string(error.what()));
        }
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
        addWorstFrames(report, run, truth, table, options.overlays);
    }
    return writeReportFile(report.html(), options.directory);
}
}  // namespace pointplane
