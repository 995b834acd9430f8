// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/units.h>

#include <ostream>

#include "OutputGuard.h"
#include "command.h"
#include "coverage_limit.h"
#include "input_options.h"
#include "notation_hint.h"
#include "number_checks.h"
#include "result_output.h"
#include "rpe_options.h"
#include "trajectory_report.h"
#include "word_check.h"

namespace pointplane
{
namespace
{
constexpr std::int64_t kScriptMaxPairs = 10000;

struct RpeCommand
{
    std::string groundTruth, estimate;
    RpeCommandOptions options;
    InputOptions input;
    OutputFiles files;
    ReportOptions report;
    bool verbose{false};
    double maxRmse{-1};
    double maxRmseDeg{-1};
    CoverageLimit coverage;

    void addTo(CLI::App& command);
    void run(CommandContext& context) const;

 private:
    [[nodiscard]] ScoredResult scored(
        const RpeOptions& rpe, const RpeResult& result, const Trajectory& measured) const;
};

void RpeCommand::addTo(CLI::App& command)
{
    command.add_option("groundtruth", groundTruth, "Ground-truth trajectory")
        ->type_name("FILE")
        ->required();
    command.add_option("estimate", estimate, "Estimated trajectory")->type_name("FILE")->required();
    options.addTo(command, true);
    command
        .add_option("--max-rmse", maxRmse, "Exit with 1 if the translation RMSE exceeds this [m]")
        ->check(isNotNegative())
        ->group("Limits");
    command
        .add_option(
            "--max-rmse-deg", maxRmseDeg, "Exit with 1 if the rotation RMSE exceeds this [deg]")
        ->check(isNotNegative())
        ->group("Limits");
    coverage.addTo(command);
    command.add_flag("--verbose", verbose, "Print the lines of evaluate_rpe.py --verbose instead")
        ->group("Output");
    input.addTo(command);
    files.addTo(command, "pair");
    report.addTo(command);
}

/** The errors pair by pair, CSV. */
std::string singlesOf(const Trajectory& estimate, const RpeResult& result)
{
    std::string out = "stamp_i,stamp_j,translation_m,rotation_deg\n";
    for (const RpePair& pair : result.pairs)
    {
        out += savedStamp(estimate.stamps[pair.i]) + "," + savedStamp(estimate.stamps[pair.j]) +
               format(",%.6g,%.6g\n", pair.translation, pair.rotation * kDegreesPerRadian);
    }
    return out;
}

ScoredResult RpeCommand::scored(
    const RpeOptions& rpe, const RpeResult& result, const Trajectory& measured) const
{
    ScoredResult out;
    out.title = "Relative pose error";
    out.protocol = describe(rpe, result);
    out.groundTruth = groundTruth;
    out.estimate = estimate;
    out.rows = {
        {"translation", "m", result.translation},
        {"rotation", "deg", scaled(result.rotation, kDegreesPerRadian)}};
    out.details = {
        {"pairs", result.translation.count},
        {"candidatePairs", result.candidatePairs},
        {"pairsOffDelta", result.pairsOffDelta},
        {"pairsOfOtherTime", result.pairsOfOtherTime},
        {"coverage", toJson(result.coverage)},
        {"fixedDelta", rpe.fixedDelta},
        {"delta", rpe.delta},
        {"deltaUnit", nameOf(rpe.unit)},
        {"offset", rpe.offset},
        {"scale", rpe.scale}};
    out.singles = singlesOf(measured, result);
    return out;
}

void RpeCommand::run(CommandContext& context) const
{
    OutputGuard guard;
    guard.addInput(groundTruth);
    guard.addInput(estimate);
    files.guardedBy(guard, verbose);
    report.guardedBy(guard);
    const RpeOptions rpe = options.resolved();
    ReportedRun run;
    run.groundTruth = input.loadTruth(groundTruth, context);
    run.estimate = input.loadEstimate(estimate, context);
    checkOrder(run.groundTruth, run.estimate, context);
    checkTruthRate(run.groundTruth, run.estimate, context);
    const ReportInputs inputs = report.read(run.estimate);
    run.rpe = rpe;
    run.ate.offset = rpe.offset;
    run.ate.scale = rpe.scale;
    run.nees.offset = rpe.offset;
    run.nees.T_truth_body = input.T_truth_body();
    run.intervals = {{1, DeltaUnit::Frames}, {1, DeltaUnit::Seconds}};
    const Trajectory measured = withoutLost(run.estimate);
    const Trajectory truth = withBody(run.groundTruth, run.nees.T_truth_body);
    const RpeResult result = relativePoseError(truth, measured, rpe);
    run.hint = hintAtAxes(input, run.groundTruth, measured, result, rpe);
    if (run.hint.empty())
    {
        run.hint = hintAtNotation(truth, measured, rpe.offset, rpe.scale);
    }
    context.hint(run.hint);
    if (!files.save.empty() && result.pairs.empty())
    {
        throw InputError("--save: too many pairs to write; give --fixed-delta or --max-pairs");
    }
    const ScoredResult score = scored(rpe, result, measured);
    if (verbose)
    {
        context.out << format("compared_pairs %zu pairs\n", result.translation.count);
        printAsScripts("translational_error", score.rows[0].statistics, "m", context.out);
        printAsScripts("rotational_error", score.rows[1].statistics, "deg", context.out);
    }
    writeResult(score, files, context.out, !verbose);
    writeTrajectoryReport(run, report, inputs, context);
    checkThreshold("translation RMSE", score.rows[0], maxRmse, context);
    checkThreshold("rotation RMSE", score.rows[1], maxRmseDeg, context);
    const bool isJudged = maxRmse >= 0 || maxRmseDeg >= 0;
    coverage.check(estimate, result.coverage, isJudged ? ScoreIs::Judged : ScoreIs::Shown, context);
}
}  // namespace

void RpeCommandOptions::addTo(CLI::App& command, bool choosesPairs)
{
    const std::string group = "Protocol";
    CLI::Option* fixedDelta = command.add_flag(
        "--fixed-delta", rpe.fixedDelta, "Only pairs --delta apart (default: all pairs)");
    CLI::Option* delta =
        command.add_option("--delta", rpe.delta, "Distance between the two poses of a pair");
    delta->capture_default_str()->check(isPositive())->group(group);
    CLI::Option* deltaUnit =
        command.add_option("--delta-unit", unit, "s, m, rad, deg or f (frames)");
    deltaUnit->capture_default_str()->check(isOneOf({"s", "m", "rad", "deg", "f"}))->group(group);
    fixedDelta->group(choosesPairs ? group : "");
    if (choosesPairs)
    {
        delta->needs(fixedDelta);
        deltaUnit->needs(fixedDelta);
    }
    command.add_option("--offset", rpe.offset, "Add this to the estimate's stamps [s]")
        ->check(isFinite())
        ->capture_default_str()
        ->group(group);
    command.add_option("--scale", rpe.scale, "Multiply the estimate's translations by this")
        ->check(isPositive())
        ->capture_default_str()
        ->group(group);
    command
        .add_option(
            "--max-pairs",
            maxPairs,
            choosesPairs ? "At most so many pairs, drawn at random; 0 = all (default: 10000, with "
                           "--fixed-delta all)"
                         : "At most so many pairs, drawn at random; 0 = all")
        ->check(isNotNegative())
        ->group(group);
    command.add_option("--seed", rpe.seed, "Seed of the random draw")
        ->capture_default_str()
        ->group(group);
    command
        .add_flag("--evo", evo, "Use the formula of the TUM paper and of evo, not the TUM script's")
        ->group(group);
    command
        .add_flag(
            "--interpolate", interpolate, "Interpolate ground truth instead of taking the nearest")
        ->group(group);
}

RpeOptions RpeCommandOptions::resolved() const
{
    RpeOptions out = rpe;
    out.unit = deltaUnitFromName(unit);
    out.maxPairs = maxPairs >= 0 ? maxPairs : (rpe.fixedDelta ? 0 : kScriptMaxPairs);
    out.formula = evo ? RpeFormula::Evo : RpeFormula::TumScript;
    out.truthAt = interpolate ? TruthAt::Interpolated : TruthAt::NearestStamp;
    return out;
}

void addRpeCommand(CLI::App& app, CommandContext& context)
{
    addCommand<RpeCommand>(
        app,
        context,
        "rpe",
        "Relative pose error, by the protocol of the TUM benchmark's evaluate_rpe.py");
}
}  // namespace pointplane
