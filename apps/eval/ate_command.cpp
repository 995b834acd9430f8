// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/ate.h>

#include <map>
#include <ostream>

#include "OutputGuard.h"
#include "command.h"
#include "coverage_limit.h"
#include "input_options.h"
#include "notation_hint.h"
#include "number_checks.h"
#include "result_output.h"
#include "trajectory_report.h"
#include "word_check.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kFewPoses = 10;

struct AteCommand
{
    std::string groundTruth, estimate;
    AteOptions options;
    InputOptions input;
    OutputFiles files;
    ReportOptions report;
    bool verbose{false};
    double maxRmse{-1};
    CoverageLimit coverage;

    void addTo(CLI::App& command);
    void run(CommandContext& context) const;
};

void AteCommand::addTo(CLI::App& command)
{
    const std::string group = "Protocol";
    command.add_option("groundtruth", groundTruth, "Ground-truth trajectory")
        ->type_name("FILE")
        ->required();
    command.add_option("estimate", estimate, "Estimated trajectory")->type_name("FILE")->required();
    command.add_option("--offset", options.offset, "Add this to the estimate's stamps [s]")
        ->check(isFinite())
        ->capture_default_str()
        ->group(group);
    command.add_option("--scale", options.scale, "Multiply the estimate's translations by this")
        ->check(isPositive())
        ->capture_default_str()
        ->group(group);
    command
        .add_option(
            "--max-difference",
            options.maxDifference,
            "Longest time between poses that are compared [s]")
        ->capture_default_str()
        ->check(isPositive())
        ->group(group);
    const std::map<std::string, Alignment> alignments{
        {"se3", Alignment::Se3}, {"first", Alignment::FirstPose}, {"none", Alignment::None}};
    command
        .add_option_function<std::string>(
            "--align",
            [this, alignments](const std::string& word)
            { options.alignment = alignments.at(word); },
            "How trajectories are aligned: se3 (as the script), first or none")
        ->check(isOneOf({"se3", "first", "none"}))
        ->default_str("se3")
        ->group(group);
    command.add_option("--max-rmse", maxRmse, "Exit with 1 if the RMSE exceeds this [m]")
        ->check(isNotNegative())
        ->group("Limits");
    coverage.addTo(command);
    command.add_flag("--verbose", verbose, "Print the lines of evaluate_ate.py --verbose instead")
        ->group("Output");
    input.addTo(command);
    files.addTo(command, "pose");
    report.addTo(command);
}

/** The errors pose by pose, CSV; x, y, z in the ground truth's world. */
std::string singlesOf(const Trajectory& estimate, const AteResult& result)
{
    std::string out = "stamp,translation_m,x_m,y_m,z_m\n";
    for (const AteError& error : result.errors)
    {
        const Eigen::Vector3d& d = error.difference;
        out += savedStamp(estimate.stamps[error.estimate]) +
               format(",%.6g,%.6g,%.6g,%.6g\n", error.translation, d.x(), d.y(), d.z());
    }
    return out;
}

/** If unaligned errors are rather those of where the world is: an odometry begins its own. */
std::string hintAtWorlds(
    const Trajectory& truth, const Trajectory& estimate, AteOptions options, double rmse)
{
    if (options.alignment != Alignment::None)
    {
        return "";
    }
    options.alignment = Alignment::FirstPose;
    const double aligned = absoluteTrajectoryError(truth, estimate, options).translation.rmse;
    return aligned < 0.5 * rmse
               ? format(
                     "with --align first the RMSE would be %.6g m instead of %.6g m; are the poses "
                     "of '%s' in another world than the ground truth? (--body-from-gt does not "
                     "change the world)",
                     aligned,
                     rmse,
                     estimate.name.c_str())
               : "";
}

void AteCommand::run(CommandContext& context) const
{
    OutputGuard guard;
    guard.addInput(groundTruth);
    guard.addInput(estimate);
    files.guardedBy(guard, verbose);
    report.guardedBy(guard);
    ReportedRun run;
    run.groundTruth = input.loadTruth(groundTruth, context);
    run.estimate = input.loadEstimate(estimate, context);
    checkOrder(run.groundTruth, run.estimate, context);
    const ReportInputs inputs = report.read(run.estimate);
    run.rpe.offset = run.nees.offset = options.offset;
    run.rpe.scale = options.scale;
    run.rpe.fixedDelta = true;
    run.ate = options;
    run.nees.T_truth_body = input.T_truth_body();
    run.intervals = {{1, DeltaUnit::Frames}, {1, DeltaUnit::Seconds}};
    const Trajectory measured = withoutLost(run.estimate);
    const Trajectory truth = withBody(run.groundTruth, run.nees.T_truth_body);
    const AteResult result = absoluteTrajectoryError(truth, measured, options);
    run.hint = hintAtBodies(input, run.groundTruth, run.estimate);
    if (run.hint.empty())
    {
        run.hint = hintAtNotation(truth, measured, options.offset, options.scale);
    }
    if (run.hint.empty())
    {
        run.hint = hintAtWorlds(truth, measured, options, result.translation.rmse);
    }
    context.hint(run.hint);

    ScoredResult scored;
    scored.title = "Absolute trajectory error";
    scored.protocol = describe(options, result, measured.size());
    scored.groundTruth = groundTruth;
    scored.estimate = estimate;
    scored.rows = {{"translation", "m", result.translation}};
    scored.details = {
        {"poses", result.errors.size()},
        {"estimatePoses", measured.size()},
        {"coverage", toJson(result.coverage)},
        {"maxDifference", options.maxDifference},
        {"offset", options.offset},
        {"scale", options.scale}};
    scored.singles = singlesOf(measured, result);
    if (verbose)
    {
        context.out << format("compared_pose_pairs %zu pairs\n", result.translation.count);
        printAsScripts("absolute_translational_error", result.translation, "m", context.out);
    }
    writeResult(scored, files, context.out, !verbose);
    writeTrajectoryReport(run, report, inputs, context);
    checkThreshold("RMSE", scored.rows[0], maxRmse, context);
    if (result.errors.size() < kFewPoses)
    {
        context.err
            << context.program << ": warning: " << estimate << ": only " << result.errors.size()
            << " poses have ground truth; the alignment fits so few, whatever their errors\n";
    }
    coverage.check(
        estimate, result.coverage, maxRmse >= 0 ? ScoreIs::Judged : ScoreIs::Shown, context);
}
}  // namespace

void addAteCommand(CLI::App& app, CommandContext& context)
{
    addCommand<AteCommand>(
        app,
        context,
        "ate",
        "Absolute trajectory error, by the protocol of the TUM benchmark's evaluate_ate.py");
}
}  // namespace pointplane
