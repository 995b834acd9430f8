// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <set>

#include "FileIdentity.h"
#include "LabApp.h"
#include "OutputGuard.h"
#include "lab_runs.h"
#include "report_file.h"
#include "result_output.h"
#include "rpe_options.h"
#include "sweep_output.h"

namespace pointplane
{
namespace
{
struct SweepCommand
{
    std::string parameter;  //!< Section.key
    std::vector<std::string> rawlogs, groundTruths, values, settings;
    std::string config, report;
    std::vector<double> range;  //!< from, to, steps
    bool logarithmic{false};
    RpeCommandOptions rpe;
    LabRunner runner;
    OutputFiles files;

    void addTo(CLI::App& command);
    void run(CommandContext& context);
    [[nodiscard]] std::vector<std::string> valuesToTry() const;
    [[nodiscard]] std::vector<LabRun> runs(const std::vector<std::string>& tried) const;
};

/** Without folders and endings, where these names differ. */
std::vector<std::string> namesOf(const std::vector<std::string>& rawlogs)
{
    std::vector<std::string> stems;
    for (const std::string& rawlog : rawlogs)
    {
        stems.push_back(std::filesystem::path(rawlog).stem().string());
    }
    const std::set<std::string> different(stems.begin(), stems.end());
    return different.size() == stems.size() ? stems : rawlogs;
}

/** Whether a configuration with one is that with the other. */
bool isSameValue(const std::string& a, const std::string& b)
{
    const auto first = parseFinite(a), second = parseFinite(b);
    return first && second ? *first == *second : a == b;
}

/** The index of the first item that is like one before it, or the number of items. */
template <class Item, class IsSame>
std::size_t firstRepeated(const std::vector<Item>& items, IsSame isSame)
{
    std::size_t i = 0;
    const auto isLike = [&](const Item& other) { return isSame(other, items[i]); };
    const auto at = [&] { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    while (i < items.size() && std::none_of(items.begin(), at(), isLike))
    {
        ++i;
    }
    return i;
}

/** \throws std::invalid_argument */
void requireDifferent(
    const std::vector<std::string>& rawlogs, const std::vector<std::string>& values)
{
    const std::vector<FileIdentity> files(rawlogs.begin(), rawlogs.end());
    const auto isSameFile = [](const FileIdentity& a, const FileIdentity& b)
    { return a.isSame(b); };
    const std::string isRepeated = " is given more than once";
    if (const std::size_t i = firstRepeated(files, isSameFile); i < files.size())
    {
        throw std::invalid_argument("'" + rawlogs[i] + "'" + isRepeated);
    }
    if (const std::size_t i = firstRepeated(values, isSameValue); i < values.size())
    {
        throw std::invalid_argument("the value " + values[i] + isRepeated);
    }
}

/** If all runs would fail by their settings, the parameter is wrong, or what is set for all of
 * them. \throws InputError of the first one */
void requireOneUsable(const std::vector<LabRun>& runs)
{
    std::string problem;
    for (const LabRun& run : runs)
    {
        try
        {
            (void)loadOdometryParams(run.config, run.settings);
            return;
        }
        catch (const InputError& e)
        {
            problem = problem.empty() ? e.what() : problem;
        }
    }
    throw InputError(problem);
}

void SweepCommand::addTo(CLI::App& command)
{
    command.add_option("parameter", parameter, "Key of the configuration, e.g. PoseSolver.alpha")
        ->type_name("KEY")
        ->required();
    command.add_option("rawlogs", rawlogs, "Sequences")
        ->type_name("FILE")
        ->required()
        ->expected(1, -1);
    command.add_option("--values", values, "Values to try, e.g. 0,1,10 or surf,orb")
        ->type_name("VALUE")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->group("Runs");
    command.add_option("--range", range, "From,to,how many values: instead of --values")
        ->type_name("NUMBERS")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->group("Runs");
    command.add_flag("--log", logarithmic, "Space the values of --range logarithmically")
        ->group("Runs");
    command
        .add_option(
            "--gt",
            groundTruths,
            "Ground truth of each rawlog (default: NAME.groundtruth.txt beside it)")
        ->type_name("FILE")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->group("Runs");
    command.add_option("-c,--config", config, "Configuration of all runs")
        ->type_name("FILE")
        ->group("Runs");
    command.add_option("--set", settings, "Section.key=value for all runs")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false)
        ->group("Runs");
    runner.addTo(command);
    rpe.addTo(command);
    files.addTo(command, "");
    command.add_option("--report", report, "Write DIR/index.html: one file, with the curves")
        ->type_name("DIR")
        ->group("Output");
}

std::vector<std::string> SweepCommand::valuesToTry() const
{
    if (values.empty() == range.empty())
    {
        throw std::invalid_argument("sweep needs either --values or --range");
    }
    if (range.empty())
    {
        return values;
    }
    constexpr double kMostValues = 1000;
    if (range.size() != 3 || !(range[2] >= 2 && range[2] <= kMostValues) ||
        std::floor(range[2]) != range[2] || !std::isfinite(range[0]) || !std::isfinite(range[1]) ||
        (logarithmic && (range[0] <= 0 || range[1] <= 0)))
    {
        throw std::invalid_argument(
            "--range takes from, to and a whole number of values, 2 to 1000; with --log both ends "
            "are positive");
    }
    const double from = range[0];
    const double to = range[1];
    const auto steps = static_cast<int>(range[2]);
    std::vector<std::string> out;
    for (int k = 0; k < steps; ++k)
    {
        const double f = static_cast<double>(k) / (steps - 1);
        out.push_back(
            format("%.6g", logarithmic ? from * std::pow(to / from, f) : from + f * (to - from)));
    }
    return out;
}

std::vector<LabRun> SweepCommand::runs(const std::vector<std::string>& tried) const
{
    if (!groundTruths.empty() && groundTruths.size() != rawlogs.size())
    {
        throw std::invalid_argument("--gt needs one ground truth for each rawlog");
    }
    const std::vector<std::string> names = namesOf(rawlogs);
    std::vector<LabRun> out;
    for (std::size_t s = 0; s < rawlogs.size(); ++s)
    {
        const std::string truth =
            groundTruths.empty() ? groundTruthOf(rawlogs[s]) : groundTruths[s];
        for (const std::string& file : {rawlogs[s], truth})
        {
            if (!std::filesystem::exists(file))
            {
                throw InputError("no file '" + file + "'");
            }
        }
        for (const std::string& value : tried)
        {
            LabRun run;
            run.name = names[s] + " " + parameter + "=" + value;
            run.rawlog = rawlogs[s];
            run.groundTruth = truth;
            run.config = config;
            run.settings = settings;
            run.settings.push_back(parameter + "=" + value);
            out.push_back(std::move(run));
        }
    }
    return out;
}

void SweepCommand::run(CommandContext& context)
{
    OutputGuard guard;
    guard.addInput(config);
    for (const std::string& rawlog : rawlogs)
    {
        guard.addInput(rawlog);
        guard.addInput(groundTruthOf(rawlog));
    }
    for (const std::string& truth : groundTruths)
    {
        guard.addInput(truth);
    }
    runner.guardedBy(guard);
    files.guardedBy(guard);
    guardReport(guard, report);
    SweepResult sweep;
    sweep.parameter = parameter;
    sweep.values = valuesToTry();
    requireDifferent(rawlogs, sweep.values);
    sweep.sequences = namesOf(rawlogs);
    rpe.rpe.fixedDelta = true;
    const RpeOptions resolved = rpe.resolved();
    const std::vector<LabRun> planned = runs(sweep.values);
    runner.requireProgram();
    requireOneUsable(planned);
    sweep.scores = runner.run(planned, resolved, WorkDirectory(runner.directory), context.err);
    sweep.protocol = describe(resolved);

    if (!files.replaceTable())
    {
        printTable(sweep, context.out);
    }
    files.write(toJson(sweep), toCsv(sweep), "", context.out);
    if (!report.empty())
    {
        writeReportFile(reportOf(sweep, logarithmic), report, context);
    }
    if (const std::string failures = failuresOf(planned, sweep.scores); !failures.empty())
    {
        context.err << "pointplane-lab: " << failures << "\n";
        context.exitCode = kExitIncomplete;
    }
}
}  // namespace

void addSweepCommand(CLI::App& app, CommandContext& context)
{
    addCommand<SweepCommand>(
        app,
        context,
        "sweep",
        "Runs the odometry over a range of any parameter and draws the curve");
}
}  // namespace pointplane
