// SPDX-License-Identifier: BSD-3-Clause
#include "SimulateApp.h"

#include <pointplane/core/counted.h>
#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/mrpt_io/rawlog_names.h>
#include <pointplane/simulation/Scene.h>
#include <pointplane/simulation/scenes.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <ostream>

#include "SequenceWriter.h"
#include "label_check.h"
#include "run_program.h"
#include "standard_streams.h"
#include "word_check.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
namespace
{
constexpr const char* kSection = "Simulation";

struct Arguments
{
    std::string scene;
    std::uint64_t seed{1};
    std::string camera{"kinect"};
    bool ideal{false};
    std::optional<double> duration, fps;
    std::string size;
    std::vector<std::string> settings;
    SequenceOutput output;
};

std::string sceneHelp()
{
    std::string out = "What is seen:";
    for (const SceneInfo& info : sceneList())
    {
        out += "\n  " + info.name + ": " + info.description;
    }
    return out;
}

void addOptions(CLI::App& app, Arguments& args)
{
    app.add_option("scene", args.scene, sceneHelp())->required();
    app.add_option("-o,--output", args.output.path, "Rawlog to write")
        ->type_name("FILE")
        ->required();
    app.add_option(
           "--seed", args.seed, "Seed of motion and noise: the same seed gives the same bytes")
        ->capture_default_str();
    app.add_option("--duration", args.duration, "Length [s] (default: 18)");
    app.add_option("--fps", args.fps, "Frames a second (default: 30)");
    app.add_option("--size", args.size, "Size of the images, e.g. 320x240 (default: the camera's)")
        ->type_name("WIDTHxHEIGHT");
    app.add_option(
           "--camera",
           args.camera,
           "kinect, d435 (active stereo), azure (time of flight) or phone (LiDAR); each has its "
           "resolution, field of view, depth noise and shutters")
        ->check(isOneOf({"kinect", "d435", "azure", "phone"}))
        ->capture_default_str();
    app.add_flag("--ideal", args.ideal, "Without noise, gaps, blur and shutter effects");
    app.add_option(
           "--set",
           args.settings,
           "Set a property of the camera, key=value; once for each key (--list-settings)")
        ->type_name("KEY=VALUE")
        ->type_size(1)
        ->allow_extra_args(false);
    app.add_option("--label", args.output.label, "Label of the camera in the rawlog")
        ->type_name("LABEL")
        ->check(isLabel())
        ->capture_default_str();
    app.add_flag("--external", args.output.external, "Put the images into files beside the rawlog");
    app.add_flag(
        "--hide-shutter", args.output.hideShutter, "Leave the shutter's times out of the rawlog");
    app.add_flag(
        "--masks",
        args.output.masks,
        "Write pictures of what moves into NAME_Masks: 0 = the still world, 1, 2, ... = movers");
    app.add_option(
           "--truth-frame",
           args.output.truthFrame,
           "Whose poses the ground truth holds: optical (the camera's) or robot")
        ->check(isOneOf({"optical", "robot"}))
        ->capture_default_str();
    app.add_flag("--quiet", args.output.quiet, "Show no progress");
    app.set_version_flag("--version", POINTPLANE_VERSION);
}

/** The option that sets this key, too, if it is given. */
std::string optionFor(const std::string& key, const Arguments& args)
{
    const bool isSize = key == "width" || key == "height";
    return key == "duration" && args.duration ? "--duration"
           : key == "fps" && args.fps         ? "--fps"
           : isSize && !args.size.empty()     ? "--size"
                                              : "";
}

/** What applySettings() would say of sections, which --set does not have here. */
void requireKnown(const std::string& setting, const Arguments& args, const ParameterTable& table)
{
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos)
    {
        throw InputError("--set " + setting + ": expected key=value (see --list-settings)");
    }
    const std::string key = setting.substr(0, equals);
    if (std::none_of(
            table.begin(), table.end(), [&](const ParameterRef& p) { return p.key == key; }))
    {
        throw InputError("--set " + setting + ": unknown key '" + key + "' (see --list-settings)");
    }
    if (const std::string option = optionFor(key, args); !option.empty())
    {
        throw InputError("--set " + setting + ": " + option + " sets it, too");
    }
}

SimulationParams paramsOf(const Arguments& args)
{
    SimulationParams params =
        args.ideal ? SimulationParams::ideal(args.camera) : SimulationParams::of(args.camera);
    params.duration = args.duration.value_or(params.duration);
    params.fps = args.fps.value_or(params.fps);
    if (!args.size.empty())
    {
        int length = 0;
        if (std::sscanf(args.size.c_str(), "%9dx%9d%n", &params.width, &params.height, &length) !=
                2 ||
            static_cast<std::size_t>(length) != args.size.size())
        {
            throw InputError("--size " + args.size + ": is not of the form 640x480");
        }
    }
    const ParameterTable table = parametersOf(kSection, params);
    std::vector<std::string> settings;
    for (const std::string& setting : args.settings)
    {
        requireKnown(setting, args, table);
        settings.push_back(std::string(kSection) + "." + setting);
    }
    applySettings(settings, table);
    try
    {
        params.check();
    }
    catch (const std::invalid_argument& error)
    {
        const std::string problem = error.what();
        const std::string option = optionFor(problem.substr(0, problem.find(' ')), args);
        throw InputError((option.empty() ? "--set" : option) + ": " + problem);
    }
    return params;
}

/** Prints all settings and ends the program, as --help does. Comes after the other options, which
 * it looks at. */
void addListSettings(CLI::App& app, const Arguments& args)
{
    app.add_flag_callback(
        "--list-settings",
        [&args]
        {
            requireStandardOutput();
            SimulationParams params = paramsOf(args);
            throw CLI::CallForVersion(iniText(parametersOf(kSection, params)), 0);
        },
        "Print the keys of --set with the values in effect, and exit");
}

/** What it takes to render the same bytes again. */
std::string describe(const Arguments& args, SimulationParams params)
{
    std::string out = std::string("pointplane-simulate ") + POINTPLANE_VERSION +
                      " scene=" + args.scene + " seed=" + std::to_string(args.seed);
    SimulationParams defaults;
    const ParameterTable standard = parametersOf(kSection, defaults);
    const ParameterTable table = parametersOf(kSection, params);
    for (std::size_t i = 0; i < table.size(); ++i)
    {
        if (table[i].text() != standard[i].text())
        {
            out += " " + table[i].key + "=" + table[i].text();
        }
    }
    return out;
}

int simulate(Arguments& args, std::ostream& standard, std::ostream& err)
{
    std::ostream& out = isStandardOutput(args.output.path) ? err : standard;
    const bool writesTruth = hasPlaceBeside(args.output.path);
    const SimulationParams params = paramsOf(args);
    const SimulatedSequence sequence(args.scene, params, args.seed);
    args.output.description = describe(args, params);
    writeSequence(sequence, args.output, err);
    out << args.output.path << ": " << framesText(sequence.numFrames()) << "\n"
        << (writesTruth ? groundTruthOf(args.output.path) + ": ground truth"
                        : args.output.path + ": is not a file; the ground truth was not written")
        << "\n";
    if (std::error_code error;
        !args.output.masks && std::filesystem::exists(masksFolderOf(args.output.path), error))
    {
        err << "pointplane-simulate: warning: " << masksFolderOf(args.output.path)
            << " was there before; remove it if it is of another recording\n";
    }
    if (args.output.masks)
    {
        out << masksFolderOf(args.output.path) << ": masks of "
            << counted(sequence.scene()->movers.size(), "mover") << "\n";
    }
    return kExitOk;
}
}  // namespace

int runSimulate(const std::vector<std::string>& args, std::ostream& out, std::ostream& err)
{
    CLI::App app{
        "Renders RGB-D sequences with exact ground truth and the defects of real cameras.",
        "pointplane-simulate"};
    Arguments arguments;
    addOptions(app, arguments);
    addListSettings(app, arguments);
    return runCommand(app, args, out, err, [&] { return simulate(arguments, out, err); });
}
}  // namespace pointplane
