// SPDX-License-Identifier: BSD-3-Clause
#include "ScoreCommand.h"

#include "OutputGuard.h"
#include "command.h"

namespace pointplane
{
void ScoreCommand::addTrajectoriesTo(CLI::App& command)
{
    command.add_option("groundtruth", groundTruth, "Ground-truth trajectory")
        ->type_name("FILE")
        ->required();
    command.add_option("estimate", estimate, "Estimated trajectory")->type_name("FILE")->required();
}

LoadedRun ScoreCommand::load(double offset, double scale, CommandContext& context) const
{
    OutputGuard guard;
    guard.addInput(groundTruth);
    guard.addInput(estimate);
    files.guardedBy(guard, verbose);
    report.guardedBy(guard);
    LoadedRun out;
    ReportedRun& run = out.reported;
    run.groundTruth = input.loadTruth(groundTruth, context);
    run.estimate = input.loadEstimate(estimate, context);
    checkOrder(run.groundTruth, run.estimate, context);
    out.inputs = report.read(run.estimate, context);
    run.rpe.offset = run.ate.offset = run.nees.offset = offset;
    run.rpe.scale = run.ate.scale = scale;
    run.nees.T_truth_body = input.T_truth_body();
    run.intervals = {{1, DeltaUnit::Frames}, {1, DeltaUnit::Seconds}};
    out.measured = withoutLost(run.estimate);
    out.truth = withBody(run.groundTruth, run.nees.T_truth_body);
    return out;
}

ScoredResult ScoreCommand::titled(const std::string& title) const
{
    ScoredResult out;
    out.title = title;
    out.groundTruth = groundTruth;
    out.estimate = estimate;
    return out;
}

void ScoreCommand::write(
    const ScoredResult& result, const LoadedRun& run, CommandContext& context) const
{
    writeResult(result, files, context.out, !verbose);
    writeTrajectoryReport(run.reported, report, run.inputs, context);
}
}  // namespace pointplane
