// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/units.h>

#include <ostream>

#include "ScoreCommand.h"
#include "command.h"
#include "notation_hint.h"
#include "number_checks.h"
#include "rpe_options.h"
#include "word_check.h"

namespace pointplane
{
namespace
{
constexpr std::int64_t kScriptMaxPairs = 10000;
constexpr std::size_t kFewPairs = 10;  // as kFewPoses
constexpr const char* kProtocol = "Protocol";

struct RpeCommand : ScoreCommand
{
    RpeCommandOptions options;
    double maxRmseDeg{-1};

    void addTo(CLI::App& command);
    void run(CommandContext& context) const;

 private:
    [[nodiscard]] std::string hintOn(const LoadedRun& run, const RpeResult& result) const;
    [[nodiscard]] ScoredResult scored(
        const RpeOptions& rpe, const RpeResult& result, const Trajectory& measured) const;
};

void RpeCommand::addTo(CLI::App& command)
{
    addTrajectoriesTo(command);
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
    ScoredResult out = titled("Relative pose error");
    out.protocol = describe(rpe, result);
    out.coverage = describe(result.coverage);
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

std::string RpeCommand::hintOn(const LoadedRun& run, const RpeResult& result) const
{
    const RpeOptions& rpe = run.reported.rpe;
    const std::string hint = hintAtAxes(input, run.reported.groundTruth, run.measured, result, rpe);
    return hint.empty() ? hintAtNotation(run.truth, run.measured, rpe.offset, rpe.scale) : hint;
}

void RpeCommand::run(CommandContext& context) const
{
    const RpeOptions rpe = options.resolved();
    LoadedRun run = load(rpe.offset, rpe.scale, context);
    checkTruthRate(run.reported.groundTruth, run.reported.estimate, context);
    run.reported.rpe = rpe;
    const RpeResult result = relativePoseError(run.truth, run.measured, rpe);
    run.reported.hint = hintOn(run, result);
    context.hint(run.reported.hint);
    if (!files.save.empty() && result.pairs.empty())
    {
        throw InputError("--save: too many pairs to write; give --fixed-delta or --max-pairs");
    }
    const ScoredResult score = scored(rpe, result, run.measured);
    if (verbose)
    {
        context.out << format("compared_pairs %zu pairs\n", result.translation.count);
        printAsScripts("translational_error", score.rows[0].statistics, "m", context.out);
        printAsScripts("rotational_error", score.rows[1].statistics, "deg", context.out);
    }
    write(score, run, context);
    checkThreshold("translation RMSE", score.rows[0], maxRmse, context);
    checkThreshold("rotation RMSE", score.rows[1], maxRmseDeg, context);
    if (result.translation.count < kFewPairs)
    {
        context.tell(
            "warning",
            format(
                "%s: only %zu pairs of poses were scored",
                estimate.c_str(),
                result.translation.count));
    }
    const bool isJudged = maxRmse >= 0 || maxRmseDeg >= 0;
    coverage.check(estimate, result.coverage, isJudged ? ScoreIs::Judged : ScoreIs::Shown, context);
}
}  // namespace

void RpeCommandOptions::addDeltaTo(CLI::App& command, bool choosesPairs)
{
    CLI::Option* fixedDelta = command.add_flag(
        "--fixed-delta", rpe.fixedDelta, "Only pairs --delta apart (default: all pairs)");
    CLI::Option* delta =
        command.add_option("--delta", rpe.delta, "Distance between the two poses of a pair");
    delta->capture_default_str()->check(isPositive())->group(kProtocol);
    CLI::Option* deltaUnit =
        command.add_option("--delta-unit", unit, "s, m, rad, deg or f (frames)");
    deltaUnit->capture_default_str()
        ->check(isOneOf({"s", "m", "rad", "deg", "f"}))
        ->group(kProtocol);
    fixedDelta->group(choosesPairs ? kProtocol : "");
    if (choosesPairs)
    {
        delta->needs(fixedDelta);
        deltaUnit->needs(fixedDelta);
    }
}

void RpeCommandOptions::addTo(CLI::App& command, bool choosesPairs)
{
    addDeltaTo(command, choosesPairs);
    command.add_option("--offset", rpe.offset, "Add this to the estimate's stamps [s]")
        ->check(isFinite())
        ->capture_default_str()
        ->group(kProtocol);
    command.add_option("--scale", rpe.scale, "Multiply the estimate's translations by this")
        ->check(isPositive())
        ->capture_default_str()
        ->group(kProtocol);
    command
        .add_option(
            "--max-pairs",
            maxPairs,
            choosesPairs ? "At most so many pairs, drawn at random; 0 = all (default: 10000, with "
                           "--fixed-delta all)"
                         : "At most so many pairs, drawn at random; 0 = all")
        ->check(isNotNegative())
        ->group(kProtocol);
    command.add_option("--seed", rpe.seed, "Seed of the random draw")
        ->capture_default_str()
        ->group(kProtocol);
    command
        .add_flag("--evo", evo, "Use the formula of the TUM paper and of evo, not the TUM script's")
        ->group(kProtocol);
    command
        .add_flag(
            "--interpolate", interpolate, "Interpolate ground truth instead of taking the nearest")
        ->group(kProtocol);
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
