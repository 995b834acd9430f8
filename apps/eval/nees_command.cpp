// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/consistency.h>
#include <pointplane/evaluation/nees.h>

#include <algorithm>
#include <ostream>
#include <vector>

#include "FileIdentity.h"
#include "OutputGuard.h"
#include "command.h"
#include "coverage_limit.h"
#include "input_options.h"
#include "nees_options.h"
#include "nees_output.h"
#include "nees_pools.h"
#include "notation_hint.h"
#include "result_output.h"
#include "trajectory_report.h"

namespace pointplane
{
namespace
{
/** What the runs of one command add up to. */
struct NeesRuns
{
    std::vector<NeesInterval> intervals;  //!< to test
    NeesPools pools;
    NeesReport report;
    std::string untold;  //!< why not all that was asked for could be tested, or empty
    ReportedRun reported;
    ReportInputs inputs;
};

struct NeesCommand
{
    std::vector<std::string> files;
    NeesCommandOptions nees;
    InputOptions input;
    CoverageLimit coverage;
    OutputFiles output;
    ReportOptions html;

    void addTo(CLI::App& command);
    void run(CommandContext& context) const;

 private:
    void checkFiles() const;
    void checkOutputs() const;
    [[nodiscard]] NeesOptions resolved() const;
    void addRun(
        const std::string& truthFile,
        const std::string& estimateFile,
        NeesRuns& runs,
        CommandContext& context) const;
};

void NeesCommand::addTo(CLI::App& command)
{
    command
        .add_option(
            "trajectories",
            files,
            "Ground truth and estimate; of several runs: ground truth and estimate in turns")
        ->type_name("FILE")
        ->required()
        ->expected(2, -1);
    nees.addTo(command);
    coverage.addTo(command);
    input.addTo(command);
    output.addTo(command, "increment");
    html.addTo(command);
}

double jointNees(const NeesRun::Tested& tested)
{
    return consistencyOf(tested.increments, countIndependent(tested.increments), tested.interval)
        .joint.nees;
}

/** Whether the poses are of another body than the ground truth's. */
std::string hintAtBody(
    const InputOptions& input,
    const Trajectory& truth,
    const Trajectory& estimate,
    const NeesRun& run,
    NeesOptions options)
{
    const NeesRun::Tested& first = run.tested.front();
    if (!problemOf(first.increments, first.interval).empty())
    {
        return hintAtBodies(input, truth, estimate);
    }
    return hintAtAxes(
        input,
        truth,
        estimate,
        jointNees(first),
        0.25,
        "NEES per degree of freedom",
        [&](const Eigen::Isometry3d& T_truth_body)
        {
            options.T_truth_body = T_truth_body;
            const auto other = neesRun(truth, estimate, {first.interval}, options);
            return jointNees(other.tested.front());
        });
}

/** \throws std::invalid_argument if options contradict each other */
void NeesCommand::checkFiles() const
{
    if (files.size() % 2 != 0)
    {
        throw std::invalid_argument(
            "nees needs a ground truth for each estimate: GT EST [GT EST]...");
    }
    std::vector<FileIdentity> estimates;
    for (std::size_t k = 1; k < files.size(); k += 2)
    {
        const FileIdentity file(files[k]);
        if (std::any_of(
                estimates.begin(),
                estimates.end(),
                [&](const FileIdentity& other) { return other.isSame(file); }))
        {
            throw std::invalid_argument(
                "'" + files[k] + "' is given more than once: its increments would count twice");
        }
        estimates.push_back(file);
    }
    if (!html.directory.empty() && files.size() > 2)
    {
        throw std::invalid_argument("--report is of one run; give one ground truth and estimate");
    }
}

NeesOptions NeesCommand::resolved() const
{
    NeesOptions out = nees.resolved();
    out.T_truth_body = input.T_truth_body();
    return out;
}

void NeesCommand::checkOutputs() const
{
    OutputGuard guard;
    for (const std::string& file : files)
    {
        guard.addInput(file);
    }
    output.guardedBy(guard);
    html.guardedBy(guard);
}

void NeesCommand::addRun(
    const std::string& truthFile,
    const std::string& estimateFile,
    NeesRuns& runs,
    CommandContext& context) const
{
    const Trajectory truth = input.loadTruth(truthFile, context);
    const Trajectory estimate = input.loadEstimate(estimateFile, context);
    checkOrder(truth, estimate, context);
    checkTruthRate(truth, estimate, context);
    runs.inputs = html.read(estimate, context);
    NeesReport& report = runs.report;
    const NeesRun run = neesRun(truth, estimate, runs.intervals, report.options);
    runs.pools.add(run);
    runs.untold = run.untold.empty() ? runs.untold : run.note;
    report.coverages.push_back(coverageOf(truth, estimate, report.options.offset));
    report.saved += savedIncrements(estimateFile, estimate, run);
    if (!run.note.empty())
    {
        context.tell("note", run.note);
    }
    std::string hint = hintAtBody(input, truth, estimate, run, report.options);
    if (hint.empty())
    {
        hint = hintAtNotation(
            withBody(truth, report.options.T_truth_body),
            withoutLost(estimate),
            report.options.offset,
            1);
    }
    context.hint(hint);
    if (!html.directory.empty())
    {
        runs.reported = {truth, estimate, {}, {}, report.options, runs.intervals, hint, true};
        runs.reported.rpe.fixedDelta = true;
        runs.reported.rpe.offset = runs.reported.ate.offset = report.options.offset;
    }
}

void NeesCommand::run(CommandContext& context) const
{
    checkFiles();
    checkOutputs();
    NeesRuns runs;
    NeesReport& report = runs.report;
    report.files = files;
    report.options = resolved();
    runs.intervals = nees.resolvedIntervals();
    for (std::size_t k = 0; k < files.size(); k += 2)
    {
        addRun(files[k], files[k + 1], runs, context);
    }
    // A limit is passed only if every interval was tested.
    const bool needsAll = nees.areChosen || nees.isLimited();
    report.results = needsAll ? runs.pools.scores() : runs.pools.scoresOfTestable(context);
    writeTrajectoryReport(runs.reported, html, runs.inputs, context);
    writeReport(report, output, context.out);
    nees.checkRange(report.results, runs.untold, context);
    for (std::size_t k = 0; k < report.coverages.size(); ++k)
    {
        coverage.check(files[2 * k + 1], report.coverages[k], ScoreIs::OfAllFrames, context);
    }
}
}  // namespace

void addNeesCommand(CLI::App& app, CommandContext& context)
{
    addCommand<NeesCommand>(
        app,
        context,
        "nees",
        "Are the covariances true? Normalised estimation error squared of increments");
}
}  // namespace pointplane
