// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/compare.h>

#include <algorithm>
#include <ostream>

#include "OutputGuard.h"
#include "command.h"
#include "compare_output.h"
#include "coverage_limit.h"
#include "input_options.h"
#include "notation_hint.h"
#include "report_file.h"
#include "result_output.h"
#include "rpe_options.h"

namespace pointplane
{
namespace
{
struct CompareCommand
{
    std::string groundTruth;
    std::vector<std::string> estimates;
    RpeCommandOptions rpe;
    BootstrapOptions bootstrap;
    CoverageLimit coverage;
    InputOptions input;
    OutputFiles files;
    std::string report;

    void addTo(CLI::App& command);
    void run(CommandContext& context);

 private:
    void checkOutputs() const;
    [[nodiscard]] std::vector<Trajectory> load(
        const Trajectory& truth, CommandContext& context) const;
    [[nodiscard]] std::vector<std::string> hintsOn(
        const Comparison& comparison,
        const RpeOptions& options,
        const Trajectory& truth,
        const std::vector<Trajectory>& runs) const;
};

void CompareCommand::addTo(CLI::App& command)
{
    command.add_option("groundtruth", groundTruth, "Ground-truth trajectory")
        ->type_name("FILE")
        ->required();
    command.add_option("estimates", estimates, "Estimated trajectories")
        ->type_name("FILE")
        ->required()
        ->expected(1, -1);
    rpe.addTo(command);
    command.add_option("--resamples", bootstrap.resamples, "Samples of the bootstrap")
        ->capture_default_str()
        ->check(CLI::Range(100, 1000000))
        ->group("Protocol");
    coverage.addTo(command);
    input.addTo(command);
    files.addTo(command, "");
    command.add_option("--report", report, "Write DIR/index.html: one file, with charts")
        ->type_name("DIR")
        ->group("Output");
}

void CompareCommand::checkOutputs() const
{
    OutputGuard guard;
    guard.addInput(groundTruth);
    for (const std::string& path : estimates)
    {
        guard.addInput(path);
    }
    files.guardedBy(guard);
    guardReport(guard, report);
}

/** One --body-from-gt does not fit poses of a camera and of a robot. */
std::string hintAtOtherBodies(const std::vector<Trajectory>& runs)
{
    const auto of = [&](Body body)
    {
        return std::find_if(
            runs.begin(), runs.end(), [body](const Trajectory& t) { return t.body == body; });
    };
    const auto camera = of(Body::Camera), robot = of(Body::Robot);
    return camera == runs.end() || robot == runs.end()
               ? ""
               : format(
                     "the poses of '%s' are of the camera, those of '%s' of the robot: their "
                     "errors cannot be compared",
                     camera->name.c_str(),
                     robot->name.c_str());
}

std::vector<Trajectory> CompareCommand::load(const Trajectory& truth, CommandContext& context) const
{
    std::vector<Trajectory> out;
    for (const std::string& path : estimates)
    {
        out.push_back(withoutLost(input.loadEstimate(path, context)));
        checkOrder(truth, out.back(), context);
        checkTruthRate(truth, out.back(), context);
    }
    return out;
}

std::vector<std::string> CompareCommand::hintsOn(
    const Comparison& comparison,
    const RpeOptions& options,
    const Trajectory& truth,
    const std::vector<Trajectory>& runs) const
{
    std::vector<std::string> out{hintAtOtherBodies(runs)};
    for (std::size_t k = 0; k < runs.size(); ++k)
    {
        const std::string hint = hintAtAxes(input, truth, runs[k], comparison.runs[k].rpe, options);
        out.push_back(
            hint.empty() ? hintAtNotation(truth, runs[k], options.offset, options.scale) : hint);
    }
    out.erase(std::remove(out.begin(), out.end(), ""), out.end());
    return out;
}

std::string protocolOf(
    const Comparison& comparison, const RpeOptions& options, const BootstrapOptions& bootstrap)
{
    return describe(options, comparison.runs.front().rpe) +
           format(
               "%s, bootstrap of %zu, seed %ju",
               comparison.runs.size() == 1 ? "" : " of the first run",
               bootstrap.resamples,
               static_cast<std::uintmax_t>(bootstrap.seed));
}

void CompareCommand::run(CommandContext& context)
{
    checkOutputs();
    rpe.rpe.fixedDelta = true;  // the bootstrap needs pairs in time order
    const RpeOptions resolved = rpe.resolved();
    AteOptions ate;
    ate.offset = resolved.offset;
    ate.scale = resolved.scale;
    bootstrap.seed = resolved.seed;
    const Trajectory truth = input.loadTruthOfBody(groundTruth, context);
    const std::vector<Trajectory> runs = load(truth, context);
    const Comparison comparison = compareRuns(truth, runs, resolved, ate, bootstrap);
    const std::vector<std::string> hints = hintsOn(comparison, resolved, truth, runs);
    std::for_each(hints.begin(), hints.end(), [&](const auto& hint) { context.hint(hint); });
    const std::string protocol = protocolOf(comparison, resolved, bootstrap);
    if (!files.replaceTable())
    {
        printTable(comparison, protocol, context.out);
    }
    files.write(toJson(comparison, protocol), toCsv(comparison), "", context.out);
    if (!report.empty())
    {
        writeReportFile(
            reportOf(comparison, protocol, resolved, truth, runs, hints), report, context);
    }
    for (const ComparedRun& run : comparison.runs)
    {
        coverage.check(run.name, run.rpe.coverage, ScoreIs::Shown, context);
    }
}
}  // namespace

void addCompareCommand(CLI::App& app, CommandContext& context)
{
    addCommand<CompareCommand>(
        app,
        context,
        "compare",
        "Several runs side by side, differences with bootstrap confidence intervals");
}
}  // namespace pointplane
