// SPDX-License-Identifier: BSD-3-Clause
#include "OdometryApp.h"

#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/params_ini.h>

#include <algorithm>
#include <ostream>

#include "FileIdentity.h"
#include "OdometryOptions.h"
#include "OdometryRun.h"
#include "number_checks.h"
#include "run_program.h"
#include "standard_streams.h"
#include "word_check.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
namespace
{
void addOptions(CLI::App& app, OdometryOptions& o, bool& dumpConfig)
{
    app.add_option("rawlogs", o.inputs, "Input rawlogs, taken as one sequence")->type_name("FILE");
    app.add_option(
           "-c,--config", o.config, "Read the configuration from this file (default: built in)")
        ->type_name("FILE");
    app.add_option("--set", o.settings, "Override one key: Section.key=value; once for each key")
        ->type_name("KEY=VALUE")
        ->type_size(1)
        ->allow_extra_args(false);
    app.add_option(
           "--sensor-label",
           o.sensorLabel,
           "Use this camera of the rawlog (default: that of the first frame)")
        ->type_name("LABEL");
    app.add_option(
           "--mask",
           o.mask,
           "Image that is black (darker than half of its brightest) where the camera sees the "
           "robot "
           "itself: that is left out")
        ->type_name("FILE");
    app.add_flag("--dump-config", dumpConfig, "Print all keys with the values in effect, and exit");
}

void addRawlogOptions(CLI::App& app, OdometryOptions& o)
{
    auto* output =
        app.add_option("-o,--output", o.output, "Write a rawlog with a pose PDF per frame")
            ->type_name("FILE");
    auto* onlyPoses =
        app.add_flag("--only-poses", o.onlyPoses, "Leave the observations out of the rawlog")
            ->needs(output);
    app.add_flag(
           "--format1",
           o.format1,
           "Write the rawlog as actions (CActionRobotMovement3D) and sensory frames")
        ->needs(output);
    app.add_option(
           "--since", o.since, "Write the motions since 1 ... N frames before, too (for nees)")
        ->check(CLI::Range(1, 300))
        ->needs(output);
    app.add_flag(
           "--with-points",
           o.withPoints,
           "Put point clouds into the scans of the rawlog (rbpf-slam, maps)")
        ->needs(output)
        ->excludes(onlyPoses);
}

void addMapOptions(CLI::App& app, OdometryOptions& o)
{
    auto* simplemap =
        app.add_option(
               "--simplemap", o.simplemap, "Write key frames with pose PDFs, for observations2map")
            ->type_name("FILE");
    app.add_option(
           "--keyframe-distance",
           o.keyframeDistance,
           "Least distance between key frames of the map [m]")
        ->check(isBetween(0.001, 10))  // not millimetres
        ->capture_default_str()
        ->needs(simplemap);
    app.add_option("--keyframe-angle", o.keyframeAngleDeg, "Or least rotation between them [deg]")
        ->check(isPositive())
        ->capture_default_str()
        ->needs(simplemap);
    app.add_option(
           "--graph", o.graph, "Write a pose graph with information matrices, for graph-slam")
        ->type_name("FILE");
}

void addViewOptions(CLI::App& app, OdometryOptions& o)
{
    auto* trajectory = app.add_option("--trajectory", o.trajectory, "Write the poses as TUM text")
                           ->type_name("FILE");
    app.add_option(
           "--trajectory-frame", o.trajectoryFrame, "Whose poses: optical (the camera's) or robot")
        ->check(isOneOf({"optical", "robot"}))
        ->capture_default_str()
        ->needs(trajectory);
    app.add_option("--diagnostics", o.diagnostics, "Write a table with a line per frame (CSV)")
        ->type_name("FILE");
    auto* overlay = app.add_option(
                           "--overlay",
                           o.overlay,
                           "Draw points and planes of each frame into this folder (JPEG)")
                        ->type_name("DIR");
    app.add_option("--overlay-every", o.overlayEvery, "Draw every N-th frame only")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str()
        ->needs(overlay);
}

void addOutputOptions(CLI::App& app, OdometryOptions& o)
{
    const std::size_t numOthers = app.get_options().size();
    addRawlogOptions(app, o);
    addMapOptions(app, o);
    addViewOptions(app, o);
    const auto options = app.get_options();
    for (std::size_t i = numOthers; i < options.size(); ++i)
    {
        options[i]->group("Output");
    }
}

void addRunOptions(CLI::App& app, OdometryOptions& o)
{
    app.add_option("--first", o.first, "Skip so many frames at the start")
        ->check(isNotNegative())
        ->group("Run");
    app.add_option("--count", o.count, "Stop after so many frames")
        ->check(isPositive())
        ->group("Run");
    app.add_option("--jobs", o.jobs, "1 = one thread; more = read, estimate and write in parallel")
        ->check(CLI::Range(1, 64))
        ->capture_default_str()
        ->group("Run");
    app.add_flag("--profile", o.profile, "Print the mean time of each stage")->group("Run");
    app.add_flag("--quiet", o.quiet, "Show no progress")->group("Run");
}

void requireInputs(const OdometryOptions& o)
{
    if (o.inputs.empty())
    {
        throw InputError("no input rawlog given (see --help)");
    }
    std::vector<FileIdentity> files;
    for (const std::string& input : o.inputs)
    {
        const FileIdentity file(input);
        const auto isSame = [&file](const FileIdentity& other) { return other.isSame(file); };
        if (std::any_of(files.begin(), files.end(), isSame))
        {
            throw InputError(input + ": is given more than once");
        }
        files.push_back(file);
    }
}

int run(const OdometryOptions& options, std::ostream& standard, std::ostream& err)
{
    OdometryParams params = loadOdometryParams(options.config, options.settings);
    params.covariance.history = std::max(params.covariance.history, options.since);
    requireInputs(options);
    const auto files = {
        options.output, options.simplemap, options.graph, options.trajectory, options.diagnostics};
    const bool takesOutput = std::any_of(files.begin(), files.end(), isStandardOutput);
    const RunSummary summary = runOdometry(options, params, err);
    std::ostream& out = takesOutput ? err : standard;
    const auto isEmpty = [](const std::string& name) { return name.empty(); };
    if (std::all_of(files.begin(), files.end(), isEmpty) && options.overlay.empty())
    {
        err << "pointplane-odometry: warning: nothing was written (no -o, --trajectory, ...)\n";
    }
    summary.print(out, options.profile);
    summary.printProblems(err);
    return summary.exitCode();
}
}  // namespace

int runOdometry(const std::vector<std::string>& args, std::ostream& out, std::ostream& err)
{
    CLI::App app{
        "Estimates a camera's motion from an RGB-D rawlog, with covariances.",
        "pointplane-odometry"};
    app.set_version_flag("--version", POINTPLANE_VERSION);
    OdometryOptions options;
    bool dumpConfig = false;
    addOptions(app, options, dumpConfig);
    addOutputOptions(app, options);
    addRunOptions(app, options);
    return runCommand(
        app,
        args,
        out,
        err,
        [&]
        {
            if (dumpConfig)
            {
                requireStandardOutput();
                OdometryParams params = loadOdometryParams(options.config, options.settings);
                out << iniText(parametersOf(params), OdometryParams::kFirstExpertSection);
                return kExitOk;
            }
            return run(options, out, err);
        });
}
}  // namespace pointplane
