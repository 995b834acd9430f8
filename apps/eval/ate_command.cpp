// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/ate.h>

#include <map>
#include <ostream>

#include "ScoreCommand.h"
#include "command.h"
#include "notation_hint.h"
#include "number_checks.h"
#include "word_check.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kFewPoses = 10;

struct AteCommand : ScoreCommand
{
    AteOptions options;

    void addTo(CLI::App& command);
    void run(CommandContext& context) const;

 private:
    void addProtocolTo(CLI::App& command);
    [[nodiscard]] std::string hintOn(const LoadedRun& run, const AteResult& result) const;
    [[nodiscard]] ScoredResult scored(const AteResult& result, const Trajectory& measured) const;
};

void AteCommand::addProtocolTo(CLI::App& command)
{
    const std::string group = "Protocol";
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
}

void AteCommand::addTo(CLI::App& command)
{
    addTrajectoriesTo(command);
    addProtocolTo(command);
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

std::string AteCommand::hintOn(const LoadedRun& run, const AteResult& result) const
{
    std::string hint = hintAtBodies(input, run.reported.groundTruth, run.reported.estimate);
    if (hint.empty())
    {
        hint = hintAtNotation(run.truth, run.measured, options.offset, options.scale);
    }
    return hint.empty() ? hintAtWorlds(run.truth, run.measured, options, result.translation.rmse)
                        : hint;
}

ScoredResult AteCommand::scored(const AteResult& result, const Trajectory& measured) const
{
    ScoredResult out = titled("Absolute trajectory error");
    out.protocol = describe(options, result, measured.size());
    out.coverage = describe(result.coverage);
    out.rows = {{"translation", "m", result.translation}};
    out.details = {
        {"poses", result.errors.size()},
        {"estimatePoses", measured.size()},
        {"coverage", toJson(result.coverage)},
        {"maxDifference", options.maxDifference},
        {"offset", options.offset},
        {"scale", options.scale}};
    out.singles = singlesOf(measured, result);
    return out;
}

void warnOfFewPoses(const std::string& estimate, std::size_t count, CommandContext& context)
{
    if (count < kFewPoses)
    {
        context.err
            << context.program << ": warning: " << estimate << ": only " << count
            << " poses have ground truth; the alignment fits so few, whatever their errors\n";
    }
}

void AteCommand::run(CommandContext& context) const
{
    LoadedRun run = load(options.offset, options.scale, context);
    run.reported.rpe.fixedDelta = true;
    run.reported.ate = options;
    const AteResult result = absoluteTrajectoryError(run.truth, run.measured, options);
    run.reported.hint = hintOn(run, result);
    context.hint(run.reported.hint);
    const ScoredResult score = scored(result, run.measured);
    if (verbose)
    {
        context.out << format("compared_pose_pairs %zu pairs\n", result.translation.count);
        printAsScripts("absolute_translational_error", result.translation, "m", context.out);
    }
    write(score, run, context);
    checkThreshold("RMSE", score.rows[0], maxRmse, context);
    warnOfFewPoses(estimate, result.errors.size(), context);
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
