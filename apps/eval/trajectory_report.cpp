// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_report.h"

#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/evaluation/units.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "OutputGuard.h"
#include "command.h"
#include "nees_output.h"
#include "report_file.h"
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

/** Adds what `section` makes, or a paragraph that says why it could not. */
template <class Section>
void addSection(HtmlReport& report, const char* what, Section section)
{
    try
    {
        section();
    }
    catch (const EnvironmentError&)
    {
        throw;
    }
    catch (const std::runtime_error& error)
    {
        report.addParagraph(std::string("No ") + what + ": " + error.what() + ".");
    }
}

const std::vector<std::string> kStatisticsHeader{"", "rmse", "mean", "median", "std", "min", "max"};

/** Scores and charts of one run without its lost frames. */
class PathSections
{
 public:
    explicit PathSections(const ReportedRun& run)
        : run_(run),
          truth_(withBody(run.groundTruth, run.nees.T_truth_body)),
          measured_(withoutLost(run.estimate)),
          fixedDelta_(run.rpe)
    {
        fixedDelta_.fixedDelta = true;
        fixedDelta_.maxPairs = run.rpe.fixedDelta ? run.rpe.maxPairs : 0;
    }

    void addTo(HtmlReport& report) const
    {
        addSection(report, "relative pose error", [&] { addRelativeTable(report); });
        addSection(report, "absolute trajectory error", [&] { addAbsolute(report); });
        addSection(report, "charts of relative errors", [&] { addRelativeCharts(report); });
        addAll(report, errorOverInterval(truth_, measured_, run_.rpe));
        addSection(report, "poses over time", [&] { addPoses(report); });
    }

 private:
    static void addAll(HtmlReport& report, const std::vector<Chart>& charts)
    {
        for (const Chart& chart : charts)
        {
            report.addChart(chart);
        }
    }

    void addRelativeTable(HtmlReport& report) const
    {
        const RpeResult rpe = relativePoseError(truth_, measured_, run_.rpe);
        report.addTable(
            "Relative pose error: " + describe(run_.rpe, rpe),
            kStatisticsHeader,
            {statisticsCells("translation [mm]", scaled(rpe.translation, 1000)),
             statisticsCells("rotation [deg]", scaled(rpe.rotation, kDegreesPerRadian))});
    }

    void addAbsolute(HtmlReport& report) const
    {
        const AteResult ate = absoluteTrajectoryError(truth_, measured_, run_.ate);
        report.addTable(
            "Absolute trajectory error: " + describe(run_.ate, ate, measured_.size()),
            kStatisticsHeader,
            {statisticsCells("translation [mm]", scaled(ate.translation, 1000))});
        // Covariances are relative to the first pose, so that is where ellipses start from.
        const bool fromStart =
            !measured_.covs.empty() && run_.ate.alignment != Alignment::FirstPose;
        const AteResult map =
            fromStart ? absoluteTrajectoryError(truth_, measured_, aligned()) : ate;
        if (fromStart)
        {
            report.addParagraph(
                "The paths are aligned at the first pose, where the covariances start. So their "
                "errors grow from there, and are not those of the table.");
        }
        addAll(report, pathCharts(truth_, {{"estimate", measured_, map, run_.ate.scale}}));
        report.addChart(positionErrorChart(measured_, ate));
        report.addChart(positionErrorHistogram(ate));
    }

    void addRelativeCharts(HtmlReport& report) const
    {
        const RpeResult rpe = relativePoseError(truth_, measured_, fixedDelta_);
        addAll(report, relativeErrorCharts(measured_, fixedDelta_, rpe));
        addAll(report, errorHistograms(fixedDelta_, rpe));
    }

    void addPoses(HtmlReport& report) const
    {
        const std::vector<Chart> charts = poseCharts(
            truth_, measured_, run_.ate, absoluteTrajectoryError(truth_, measured_, aligned()));
        report.addParagraph("Poses in the ground truth's world, aligned at the first one:");
        addAll(report, charts);
    }

    [[nodiscard]] AteOptions aligned() const
    {
        AteOptions out = run_.ate;
        out.alignment = Alignment::FirstPose;
        return out;
    }

    const ReportedRun& run_;
    Trajectory truth_, measured_;
    RpeOptions fixedDelta_;
};

std::vector<std::string> consistencyCells(const std::string& name, const NeesResult& r)
{
    const ConsistencyTest& t = r.joint;
    const std::string judgement =
        t.isOptimistic() ? "optimistic, sigmas x " + numberText(std::sqrt(t.nees), 2) + " too small"
        : t.isConservative()
            ? "conservative, sigmas x " + numberText(1 / std::sqrt(t.nees), 2) + " too large"
            : "consistent";
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

/** NEES table and charts; the charts of single errors for the first interval only.
 * \throws std::runtime_error where there is no NEES */
void addConsistency(HtmlReport& report, const ReportedRun& run)
{
    std::vector<std::vector<std::string>> rows;
    std::vector<Chart> charts;
    std::vector<Chart> errors;
    const NeesRun tested = neesRun(run.groundTruth, run.estimate, run.intervals, run.nees);
    for (const auto& [interval, increments] : tested.tested)
    {
        const auto result = consistencyOf(increments, countIndependent(increments), interval);
        rows.push_back(consistencyCells(
            interval.sinceStart ? "poses since the first" : nameOf(interval), result));
        charts.push_back(neesChart(run.estimate, increments, result));
        if (errors.empty())
        {
            errors = errorAgainstSigmaCharts(run.estimate, increments, interval);
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
    if (!tested.note.empty())
    {
        report.addParagraph("Note: " + tested.note + ".");
    }
    std::for_each(charts.begin(), charts.end(), [&](const Chart& c) { report.addChart(c); });
}

/** Numbers that pointplane-odometry gave to frames. */
class FrameNumbers
{
 public:
    /** \param table in the order of the recording: frames that are lost for a late stamp are not in
     * the order of stamps */
    explicit FrameNumbers(const FrameTable& table)
    {
        const std::vector<double> frames = table.column("frame");
        std::vector<std::pair<double, double>> sorted;
        for (std::size_t k = 0; k < frames.size(); ++k)
        {
            if (frames[k] >= 0)  // not NaN
            {
                sorted.emplace_back(table.stamps()[k], frames[k]);
            }
        }
        std::sort(sorted.begin(), sorted.end());
        for (const auto& [stamp, frame] : sorted)
        {
            stamps_.push_back(stamp);
            frames_.push_back(static_cast<std::size_t>(frame));
        }
    }

    /** \param index of the pose, its number where there is no table */
    [[nodiscard]] std::size_t of(double stamp, std::size_t index) const
    {
        return stamps_.empty() ? index : frames_[nearestIndex(stamps_, stamp)];
    }

 private:
    std::vector<double> stamps_;
    std::vector<std::size_t> frames_;
};

/** Pictures, of those that there are, of the frames whose motion from the previous frame is the
 * most wrong. */
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
    const FrameNumbers numbers(table);
    std::size_t numPictures = 0;
    for (const RpePair& pair : pairs)
    {
        const double stamp = run.estimate.stamps[pair.j];
        const std::size_t frame = numbers.of(stamp, pair.j);
        const std::string picture = folder + format("/%06zu.jpg", frame);
        if (numPictures == kWorstFrames || !std::filesystem::exists(picture))
        {
            continue;
        }
        ++numPictures;
        report.addPicture(
            format(
                "Frame %zu at %.2f s: motion off by %.1f mm, %.2f deg",
                frame,
                stamp - run.estimate.stamps.front(),
                1000 * pair.translation,
                kDegreesPerRadian * pair.rotation),
            picture);
    }
    if (numPictures == 0)
    {
        throw InputError(folder + ": no picture 000001.jpg, ... of these frames is in it");
    }
}

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
    PathSections(run).addTo(report);
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
        const Trajectory truth = withBody(run.groundTruth, run.nees.T_truth_body);
        addWorstFrames(report, run, truth, table, options.overlays);
    }
    if (!options.runConfig.empty())
    {
        report.addDetails(
            "Configuration of the run: " + options.runConfig, textOf(options.runConfig));
    }
    writeReportFile(std::move(report), options.directory, context);
}
}  // namespace pointplane
