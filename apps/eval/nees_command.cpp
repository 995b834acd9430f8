// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/units.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <set>

#include "command.h"
#include "input_options.h"
#include "nees_output.h"
#include "result_output.h"
#include "trajectory_report.h"

namespace pointplane
{
namespace
{
struct NeesCommand
{
    std::vector<std::string> files;
    std::vector<std::string> intervals{"1f", "10f", "1s"};
    InputOptions input;
    NeesOptions options;
    std::string sigmaRotationDeg{"0"};  //!< s or x,y,z
    bool nearest{false};
    double minNees{-1};
    double maxNees{-1};
    OutputFiles output;
    ReportOptions html;

    void addTo(CLI::App& command);
    void run(CommandContext& context) const;
};

/** Standard deviations [rad] from "s" or "x,y,z" [deg]. */
Eigen::Vector3d sigmaFromOption(const std::string& text)
{
    std::vector<double> v = numbersFromOption(text);
    if (v.size() == 1)
    {
        v.resize(3, v.front());
    }
    const auto isSigma = [](double value) { return std::isfinite(value) && value >= 0; };
    if (v.size() != 3 || !std::all_of(v.begin(), v.end(), isSigma))
    {
        throw std::invalid_argument(
            "--gt-sigma-rot-deg: '" + text +
            "' is neither a standard deviation in deg nor three as x,y,z");
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
        ->required()
        ->expected(2, -1);
    command.add_option("--interval", intervals, "Lengths of the increments: frames or seconds")
        ->delimiter(',')
        ->capture_default_str()
        ->group("Protocol");
    command
        .add_option(
            "--gt-sigma-trans",
            options.truthSigmaTranslation,
            "Standard deviation of each ground-truth position, per axis [m]")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber)
        ->group("Protocol");
    command
        .add_option(
            "--gt-sigma-rot-deg",
            sigmaRotationDeg,
            "Standard deviation of each ground-truth rotation [deg]: one for all axes, or x,y,z, "
            "about the axes of the ground truth's body")
        ->capture_default_str()
        ->group("Protocol");
    command.add_option("--offset", options.offset, "Added to the estimate's stamps [s]")
        ->capture_default_str()
        ->group("Protocol");
    command.add_flag("--nearest", nearest, "Ground truth at the nearest stamp, not interpolated")
        ->group("Protocol");
    command.add_option("--min-nees", minNees, "Exit with 1 if a joint NEES per dof is below this")
        ->group("Gate");
    command.add_option("--max-nees", maxNees, "Exit with 1 if a joint NEES per dof is above this")
        ->group("Gate");
    input.addTo(command);
    output.addTo(command);
    html.addTo(command);
}

void NeesCommand::run(CommandContext& context) const
{
    if (files.size() % 2 != 0)
    {
        throw std::invalid_argument(
            "nees needs a ground truth for each estimate: GT EST [GT EST]...");
    }
    if (!html.directory.empty() && files.size() > 2)
    {
        throw std::invalid_argument("--report is of one run; give one ground truth and estimate");
    }
    NeesOptions resolved = options;
    resolved.truthSigmaRotation = sigmaFromOption(sigmaRotationDeg);
    resolved.truthAt = nearest ? TruthAt::NearestStamp : TruthAt::Interpolated;
    resolved.T_truth_body = input.T_truth_body();

    std::vector<NeesInterval> lengths;
    for (const std::string& name : intervals)
    {
        lengths.push_back(neesIntervalFromName(name));
    }
    std::vector<std::vector<NeesIncrement>> pooled(lengths.size());
    std::vector<std::size_t> independent(lengths.size(), 0);
    std::set<std::string> notes;
    for (std::size_t k = 0; k < files.size(); k += 2)
    {
        const Trajectory truth = input.loadTruth(files[k], context);
        const Trajectory estimate = input.loadEstimate(files[k + 1], context);
        for (std::size_t m = 0; m < lengths.size(); ++m)
        {
            const auto increments = neesIncrements(truth, estimate, lengths[m], resolved);
            independent[m] += countIndependent(increments);
            notes.insert(noteOnUntold(estimate, increments));
            pooled[m].insert(pooled[m].end(), increments.begin(), increments.end());
        }
        if (!html.directory.empty())
        {
            const ReportedRun reported{truth, estimate, RpeOptions(), resolved, lengths};
            context.err << "report: " << writeTrajectoryReport(reported, html) << "\n";
        }
    }
    NeesReport report;
    report.files = files;
    report.options = resolved;
    for (std::size_t m = 0; m < lengths.size(); ++m)
    {
        report.results.push_back(consistencyOf(pooled[m], independent[m], lengths[m]));
    }
    writeReport(report, output, context.out);
    notes.erase("");
    for (const std::string& note : notes)
    {
        context.err << "pointplane-eval: note: " << note << "\n";
    }
    for (const NeesResult& result : report.results)
    {
        const double nees = result.joint.nees;
        if ((maxNees >= 0 && nees > maxNees) || (minNees >= 0 && nees < minNees))
        {
            context.err << format(
                "pointplane-eval: NEES per dof %.3f at %s is outside the stated range\n",
                nees,
                nameOf(result.interval).c_str());
            context.exitCode = kExitIncomplete;
        }
    }
}
}  // namespace

void addNeesCommand(CLI::App& app, CommandContext& context)
{
    CLI::App& command = *app.add_subcommand(
        "nees", "Are the covariances honest? Normalised estimation error squared of increments");
    const auto options = std::make_shared<NeesCommand>();
    options->addTo(command);
    command.callback([options, &context] { options->run(context); });
}
}  // namespace pointplane
