// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/consistency.h>
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/units.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <set>

#include "OutputGuard.h"
#include "command.h"
#include "coverage_limit.h"
#include "input_options.h"
#include "nees_output.h"
#include "number_checks.h"
#include "result_output.h"
#include "trajectory_report.h"

namespace pointplane
{
namespace
{
constexpr double kLargestSigma = 1000;    // [m] whose square is far from overflow
constexpr double kLargestSigmaDeg = 180;  // no rotation is larger

struct NeesCommand
{
    std::vector<std::string> files;
    std::vector<std::string> intervals{"1f", "10f", "1s"};
    bool areChosen{false};  //!< the intervals, by the user
    InputOptions input;
    NeesOptions options;
    std::string sigmaRotationDeg{"0"};  //!< s or x,y,z
    bool nearest{false};
    double minNees{-1};
    double maxNees{-1};
    CoverageLimit coverage;
    OutputFiles output;
    ReportOptions html;

    void addTo(CLI::App& command);
    void run(CommandContext& context) const;

 private:
    void checkFiles() const;
    [[nodiscard]] NeesOptions resolved() const;
    void checkRange(
        const std::vector<NeesResult>& results,
        const std::string& untold,
        CommandContext& context) const;
};

/** Standard deviations [rad] from "s" or "x,y,z" [deg]. */
Eigen::Vector3d sigmaFromOption(const std::string& text)
{
    std::vector<double> v = numbersFromOption(text);
    if (v.size() == 1)
    {
        v.resize(3, v.front());
    }
    const auto isSigma = [](double value) { return value >= 0 && value <= kLargestSigmaDeg; };
    if (v.size() != 3 || !std::all_of(v.begin(), v.end(), isSigma))
    {
        throw std::invalid_argument(
            "--gt-sigma-rot-deg: '" + text +
            "' is neither a standard deviation in deg nor three as x,y,z (from 0 to 180)");
    }
    return Eigen::Vector3d(v[0], v[1], v[2]) / kDegreesPerRadian;
}

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
    command.add_option("--interval", intervals, "Lengths of the increments: frames or seconds")
        ->delimiter(',')
        ->capture_default_str()
        ->each([this](const std::string&) { areChosen = true; })
        ->group("Protocol");
    command
        .add_option(
            "--gt-sigma-trans",
            options.truthSigmaTranslation,
            "Standard deviation of each ground-truth position, per axis [m]")
        ->capture_default_str()
        ->check(isBetween(0, kLargestSigma))
        ->group("Protocol");
    command
        .add_option(
            "--gt-sigma-rot-deg",
            sigmaRotationDeg,
            "Standard deviation of each ground-truth rotation [deg]: one for all axes, or x,y,z, "
            "about the axes of the ground truth's body")
        ->capture_default_str()
        ->group("Protocol");
    command.add_option("--offset", options.offset, "Add this to the estimate's stamps [s]")
        ->check(isFinite())
        ->capture_default_str()
        ->group("Protocol");
    command
        .add_flag(
            "--nearest",
            nearest,
            "Take ground truth at the nearest stamp instead of interpolating it")
        ->group("Protocol");
    command.add_option("--min-nees", minNees, "Exit with 1 if a joint NEES per dof is below this")
        ->check(isNotNegative())
        ->group("Limits");
    command.add_option("--max-nees", maxNees, "Exit with 1 if a joint NEES per dof is above this")
        ->check(isNotNegative())
        ->group("Limits");
    coverage.addTo(command);
    input.addTo(command);
    output.addTo(command, "increment");
    html.addTo(command);
}

/** Increments of one interval, of all runs. */
struct Pool
{
    NeesInterval interval;
    std::vector<NeesIncrement> increments;
    std::size_t independent{0};
};

void poolRun(std::vector<Pool>& pools, const NeesRun& run)
{
    for (const NeesRun::Tested& tested : run.tested)
    {
        const std::string name = nameOf(tested.interval);
        auto pool = std::find_if(
            pools.begin(), pools.end(), [&](const Pool& p) { return nameOf(p.interval) == name; });
        if (pool == pools.end())
        {
            pool = pools.insert(pools.end(), {tested.interval, {}, 0});
        }
        pool->independent += countIndependent(tested.increments);
        pool->increments.insert(
            pool->increments.end(), tested.increments.begin(), tested.increments.end());
    }
}

/** Of those with enough increments. Others are errors if the user chose them, or if none has. */
std::vector<NeesResult> scoresOf(
    const std::vector<Pool>& pools, bool areChosen, CommandContext& context)
{
    const auto problem = [](const Pool& pool) { return problemOf(pool.increments, pool.interval); };
    const bool isRequired =
        areChosen ||
        std::none_of(
            pools.begin(), pools.end(), [&](const Pool& pool) { return problem(pool).empty(); });
    std::vector<NeesResult> out;
    for (const Pool& pool : pools)
    {
        if (isRequired || problem(pool).empty())
        {
            out.push_back(consistencyOf(pool.increments, pool.independent, pool.interval));
        }
        else
        {
            context.err << context.program << ": note: left out: " << problem(pool) << "\n";
        }
    }
    return out;
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

/** One line per increment: error, sigma and NEES. */
std::string savedIncrements(const std::string& file, const Trajectory& estimate, const NeesRun& run)
{
    std::string out;
    for (const NeesRun::Tested& tested : run.tested)
    {
        for (const NeesIncrement& increment : tested.increments)
        {
            out += csvField(file) + "," + nameOf(tested.interval) + "," +
                   savedStamp(estimate.stamps[increment.i]) + "," +
                   savedStamp(estimate.stamps[increment.j]);
            for (Eigen::Index k = 0; k < 6; ++k)
            {
                out += format(",%.6g", increment.error[k]);
            }
            for (Eigen::Index k = 0; k < 6; ++k)
            {
                out += format(",%.6g", std::sqrt(increment.cov(k, k)));
            }
            out += format(",%.6g\n", increment.nees);
        }
    }
    return out;
}

/** \throws std::invalid_argument if options contradict each other */
void NeesCommand::checkFiles() const
{
    if (files.size() % 2 != 0)
    {
        throw std::invalid_argument(
            "nees needs a ground truth for each estimate: GT EST [GT EST]...");
    }
    std::set<std::string> estimates;
    for (std::size_t k = 1; k < files.size(); k += 2)
    {
        if (!estimates.insert(files[k]).second)
        {
            throw std::invalid_argument(
                "'" + files[k] + "' is given more than once: its increments would count twice");
        }
    }
    if (!html.directory.empty() && files.size() > 2)
    {
        throw std::invalid_argument("--report is of one run; give one ground truth and estimate");
    }
}

NeesOptions NeesCommand::resolved() const
{
    NeesOptions out = options;
    out.truthSigmaRotation = sigmaFromOption(sigmaRotationDeg);
    out.truthAt = nearest ? TruthAt::NearestStamp : TruthAt::Interpolated;
    out.T_truth_body = input.T_truth_body();
    return out;
}

/** Says which results are outside the stated range, and sets the exit code.
 * \param untold why not all that was asked for could be tested, or empty */
void NeesCommand::checkRange(
    const std::vector<NeesResult>& results,
    const std::string& untold,
    CommandContext& context) const
{
    if (!untold.empty() && (minNees >= 0 || maxNees >= 0))
    {
        throw InputError("the stated range of NEES cannot be checked: " + untold);
    }
    for (const NeesResult& result : results)
    {
        const double nees = result.joint.nees;
        if ((maxNees >= 0 && !(nees <= maxNees)) ||
            (minNees >= 0 && !(nees >= minNees)))  // nor NaN
        {
            context.err << "pointplane-eval: NEES per dof " << numberText(nees, 3) << " at "
                        << nameOf(result.interval) << " is outside the stated range\n";
            context.exitCode = kExitIncomplete;
        }
    }
}

void NeesCommand::run(CommandContext& context) const
{
    checkFiles();
    OutputGuard guard;
    for (const std::string& file : files)
    {
        guard.addInput(file);
    }
    output.guardedBy(guard);
    html.guardedBy(guard);
    NeesReport report;
    report.files = files;
    report.options = resolved();
    std::vector<NeesInterval> lengths;
    for (const std::string& name : intervals)
    {
        lengths.push_back(neesIntervalFromName(name));
        const auto isSame = [&](const NeesInterval& other)
        { return nameOf(other) == nameOf(lengths.back()); };
        if (std::any_of(lengths.begin(), lengths.end() - 1, isSame))
        {
            throw std::invalid_argument(
                "--interval: " + nameOf(lengths.back()) + " is given more than once");
        }
    }
    std::vector<Pool> pools;
    ReportedRun reported;
    ReportInputs inputs;
    std::string untold;
    for (std::size_t k = 0; k < files.size(); k += 2)
    {
        const Trajectory truth = input.loadTruth(files[k], context);
        const Trajectory estimate = input.loadEstimate(files[k + 1], context);
        checkOrder(truth, estimate, context);
        checkTruthRate(truth, estimate, context);
        inputs = html.read(estimate);
        const NeesRun run = neesRun(truth, estimate, lengths, report.options);
        poolRun(pools, run);
        untold = run.untold.empty() ? untold : run.note;
        report.coverages.push_back(coverageOf(truth, estimate, report.options.offset));
        report.saved += savedIncrements(files[k + 1], estimate, run);
        if (!run.note.empty())
        {
            context.err << "pointplane-eval: note: " << run.note << "\n";
        }
        const std::string hint = hintAtBody(input, truth, estimate, run, report.options);
        context.hint(hint);
        if (!html.directory.empty())
        {
            reported = {truth, estimate, {}, {}, report.options, lengths, hint};
            reported.rpe.fixedDelta = true;
            reported.rpe.offset = reported.ate.offset = report.options.offset;
        }
    }
    report.results = scoresOf(pools, areChosen, context);
    writeTrajectoryReport(reported, html, inputs, context);
    writeReport(report, output, context.out);
    checkRange(report.results, untold, context);
    for (std::size_t k = 0; k < report.coverages.size(); ++k)
    {
        coverage.check(files[2 * k + 1], report.coverages[k], ScoreIs::OfAllFrames, context);
    }
}
}  // namespace

void addNeesCommand(CLI::App& app, CommandContext& context)
{
    CLI::App& command = *app.add_subcommand(
        "nees", "Are the covariances true? Normalised estimation error squared of increments");
    const auto options = std::make_shared<NeesCommand>();
    options->addTo(command);
    command.callback([options, &context] { options->run(context); });
}
}  // namespace pointplane
