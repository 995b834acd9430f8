// SPDX-License-Identifier: BSD-3-Clause
#include "convert_options.h"

#include <pointplane/mrpt_io/ScanWriter.h>

#include <string>

#include "label_check.h"
#include "number_checks.h"

namespace pointplane
{
namespace
{
void addOutputOptions(CLI::App& command, RecordingOutput& output)
{
    command.add_option("-o,--output", output.path, "Rawlog to write")
        ->type_name("FILE")
        ->required();
    command.add_option("--label", output.label, "Label of the camera in the rawlog")
        ->type_name("LABEL")
        ->check(isLabel())
        ->capture_default_str();
    auto* external = command.add_flag(
        "--external", output.external, "Put the images into files beside the rawlog");
    command.add_flag("--embedded", "Put them into the rawlog (default)")->excludes(external);
    command.add_flag(
        "--strict", output.strict, "Stop at a frame that cannot be read (default: leave it out)");
    command.add_flag("--quiet", output.quiet, "Show no progress");
}

constexpr const char* kEvenStampsHelp =
    "Take stamps for those of a camera with a steady rate: without a host's jitter and rounding. "
    "Poses then belong to these stamps";

const std::string kCameraFile =
    "file: MRPT's camera ini, Open3D's .json, or one line `fx fy cx cy k1 k2 p1 p2 k3 width height "
    "unitsPerMetre`";
const std::string kFileHelp = "Calibration, a ";
const std::string kPresetHelp = "Calibration: fr1, fr2, fr3, or a ";

/** \param otherwise the scale if none is given */
void addDepthScale(CLI::App& command, double& unitsPerMetre, const std::string& otherwise)
{
    command
        .add_option(
            "--depth-scale", unitsPerMetre, "Depth units per metre (default: " + otherwise + ")")
        ->check(isBetween(kLeastDepthUnits, kMostDepthUnits));
}

void addMaxDifference(CLI::App& command, double& seconds)
{
    command
        .add_option(
            "--max-difference", seconds, "Longest time between colour and depth of a frame [s]")
        ->check(isPositive())
        ->capture_default_str();
}

void addTumCommand(CLI::App& app, TumOptions& options, RecordingOutput& output)
{
    CLI::App* tum =
        app.add_subcommand("tum", "A sequence of the TUM RGB-D benchmark, or a folder like one");
    tum->add_option(
           "folder",
           options.folder,
           "Folder with rgb.txt, depth.txt and the images; without rgb.txt: depth alone")
        ->type_name("DIR")
        ->required();
    tum->add_option(
           "--camera",
           options.camera,
           kPresetHelp + kCameraFile +
               " (default: camera.txt in the folder, or by the folder's name)")
        ->type_name("FILE");
    addDepthScale(*tum, options.depthScale, "the camera's, 5000");
    addMaxDifference(*tum, options.maxDifference);
    tum->add_flag("--even-stamps", options.evenStamps, kEvenStampsHelp);
    addOutputOptions(*tum, output);
}

void addFolderCommand(CLI::App& app, FolderOptions& options, RecordingOutput& output)
{
    CLI::App* folder = app.add_subcommand(
        "folder",
        "Numbered or stamped images: ScanNet, 7-Scenes, Redwood, Replica, Bonn, Open3D, "
        "Record3D, StrayScanner, any two folders like rgb and depth, or one with images like "
        "rgb_12.png and depth_12.png; also depth alone");
    folder->add_option("folder", options.folder, "Folder with the images")
        ->type_name("DIR")
        ->required();
    folder
        ->add_option(
            "--camera",
            options.camera,
            kFileHelp + kCameraFile +
                " (default: camera.txt in the folder, or what its layout tells)")
        ->type_name("FILE");
    addDepthScale(
        *folder,
        options.depthScale,
        "the layout's; 5000 with rgb.txt and depth.txt; else 1000; 1 for floating point");
    folder
        ->add_option(
            "--fps",
            options.fps,
            "Frames a second, where images are numbered (default: stamps, else the "
            "layout's rate, else 30)")
        ->check(isPositive());
    addMaxDifference(*folder, options.maxDifference);
    folder->add_flag("--even-stamps", options.evenStamps, kEvenStampsHelp);
    addOutputOptions(*folder, output);
}

void addKlgCommand(CLI::App& app, KlgOptions& options, RecordingOutput& output)
{
    CLI::App* klg = app.add_subcommand("klg", "A log of Kintinuous or ElasticFusion");
    klg->add_option("file", options.file, "Log to read")->type_name("FILE")->required();
    klg->add_option(
           "--camera", options.camera, kFileHelp + kCameraFile + " (default: 528 px, 640x480)")
        ->type_name("FILE");
    addDepthScale(*klg, options.depthScale, "the camera's, 1000");
    klg->add_flag("--bgr", options.bgr, "Its colours are in the order blue, green, red");
    addOutputOptions(*klg, output);
}

void addBagCommand(CLI::App& app, BagOptions& options, RecordingOutput& output)
{
    CLI::App* bag = app.add_subcommand("bag", "A ROS 1 bag, also of RealSense's recorder");
    bag->add_option("file", options.file, "Bag to read")->type_name("FILE")->required();
    bag->add_option(
           "--colour-topic",
           options.colourTopic,
           "Topic of the colour images (default: the only ones)")
        ->type_name("TOPIC");
    bag->add_option(
           "--depth-topic",
           options.depthTopic,
           "Topic of the depth images (default: the only ones)")
        ->type_name("TOPIC");
    bag->add_option(
           "--camera",
           options.camera,
           kPresetHelp + kCameraFile + " (default: camera_info of the bag)")
        ->type_name("FILE");
    addDepthScale(*bag, options.depthScale, "the recorder's, else 1000; 1 for floating point");
    addMaxDifference(*bag, options.maxDifference);
    addOutputOptions(*bag, output);
}
}  // namespace

void addConvertCommands(CLI::App& app, ConvertOptions& options)
{
    addTumCommand(app, options.tum, options.output);
    addFolderCommand(app, options.folder, options.output);
    addKlgCommand(app, options.klg, options.output);
    addBagCommand(app, options.bag, options.output);
}
}  // namespace pointplane
