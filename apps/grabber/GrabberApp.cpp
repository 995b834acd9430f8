// SPDX-License-Identifier: BSD-3-Clause
#include "GrabberApp.h"

#include <pointplane/core/number_text.h>
#include <pointplane/mrpt_io/errors.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <ostream>

#include "GrabberOptions.h"
#include "GrabberRun.h"
#include "device_list.h"
#include "label_check.h"
#include "number_checks.h"
#include "run_program.h"
#include "standard_streams.h"
#include "word_check.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
bool GrabberOptions::recordsOni() const
{
    return std::filesystem::path(output).extension() == ".oni";
}

bool GrabberOptions::recordsRawlog() const { return !output.empty() && !recordsOni(); }

namespace
{
constexpr double kMostFrames = 1e9;  // a year of them
/** As the command line has them, before they are understood. */
struct Words
{
    std::string mode{"640x480@30"};
    std::string registration{"auto"};
    std::string images{"embedded"};
    std::string wait{"0"};  // a flag that is a number drops its decimals, and 1e9 is 1
    double splitMinutes{0};
    bool list{false};
};

/** How the camera sees, and what it is called. */
void addCalibrationOptions(CLI::App& app, GrabberOptions& o, const std::string& group)
{
    app.add_option(
           "--calibration",
           o.calibration,
           "Calibration file: yml of camera-calib, ini of rawlog-grabber")
        ->type_name("FILE")
        ->group(group);
    app.add_option("--section", o.section, "S of its sections S_LEFT, S_RIGHT, S_LEFT2RIGHT_POSE")
        ->type_name("NAME")
        ->capture_default_str()
        ->group(group);
    app.add_option("--label", o.label, "Sensor label (default: the ini file's, or OPENNI2)")
        ->type_name("LABEL")
        ->check(isLabel())
        ->group(group);
}

void addCameraOptions(CLI::App& app, GrabberOptions& o, Words& words)
{
    const std::string group = "Camera";
    app.add_option("--driver", o.driver, "Driver: auto, openni2 or freenect")
        ->capture_default_str()
        ->group(group);
    app.add_option(
           "-d,--device", o.device, "Camera: URI, serial number, index in --list, or an .oni file")
        ->type_name("CAMERA")
        ->group(group);
    app.add_option("--mode", words.mode, "Size and rate of both images")
        ->type_name("WIDTHxHEIGHT@HZ")
        ->capture_default_str()
        ->group(group);
    app.add_option(
           "--registration",
           words.registration,
           "Let the camera register depth to colour: auto, on or off")
        ->check(isOneOf({"auto", "on", "off"}))
        ->capture_default_str()
        ->group(group);
    app.add_flag("!--no-sync", o.camera.frameSync, "Do not synchronise depth and colour")
        ->group(group);
    app.add_flag("--depth-only", o.camera.depthOnly, "Record without colour")->group(group);
    app.add_flag("--lock-exposure", o.capture.lockExposure, "Keep exposure after the warm-up")
        ->group(group);
    app.add_flag(
           "--lock-white-balance", o.capture.lockWhiteBalance, "Keep colours after the warm-up")
        ->group(group);
    app.add_flag(
           "--wait{1e9}", words.wait, "Wait for a camera to appear (--wait=S: at most S seconds)")
        ->check(isNotNegative().description(""))
        ->group(group);
    app.add_option("--timeout", o.capture.stallTimeout, "Give up a silent camera after [s]")
        ->check(isPositive())
        ->capture_default_str()
        ->group(group);
    addCalibrationOptions(app, o, group);
}

/** What is written of a frame, and how fast. */
void addStorageOptions(CLI::App& app, GrabberOptions& o, Words& words, const std::string& group)
{
    app.add_option(
           "--images",
           words.images,
           "Where images go: embedded, or external (files beside the rawlog)")
        ->check(isOneOf({"embedded", "external"}))
        ->capture_default_str()
        ->group(group);
    app.add_option(
           "--compression",
           o.recording.encoding.compression,
           "Lossless compression: 0 = none, 1 = fast ... 9 = small")
        ->check(CLI::Range(0, 9))
        ->capture_default_str()
        ->group(group);
    app.add_option(
           "--jpeg",
           o.recording.encoding.jpegQuality,
           "Compress colour as JPEG of this quality (lossy)")
        ->check(CLI::Range(1, 100))
        ->group(group);
    app.add_option("--queue", o.recording.queueFrames, "Frames that may wait for the disk")
        ->check(CLI::Range(2, 100000))
        ->capture_default_str()
        ->group(group);
    app.add_option("--threads", o.recording.numThreads, "Threads that compress")
        ->check(CLI::Range(1, 64))
        ->capture_default_str()
        ->group(group);
    app.add_option("--min-free-mb", o.minFreeMb, "Stop when the disk has less left [MB]")
        ->check(isNotNegative())
        ->capture_default_str()
        ->group(group);
}

void addRecordingOptions(CLI::App& app, GrabberOptions& o, Words& words)
{
    const std::string group = "Recording";
    app.add_option("-o,--output", o.output, "Rawlog (or .oni file) to write; never overwritten")
        ->type_name("FILE")
        ->group(group);
    app.add_option("--duration", o.capture.duration, "Stop after so many seconds")
        ->check(isPositive())
        ->group(group);
    app.add_option("--frames", o.capture.maxFrames, "Stop after so many frames")
        ->check(isBetween(1, kMostFrames))
        ->group(group);
    app.add_option("--warm-up", o.capture.warmUp, "Seconds before recording begins")
        ->check(isBetween(0.2, 60))
        ->capture_default_str()
        ->group(group);
    app.add_option(
           "--max-skew",
           o.capture.maxSkew,
           "Longest time between colour and depth of a frame [s] (default: half a frame)")
        ->check(isPositive())
        ->group(group);
    app.add_option("--split-minutes", words.splitMinutes, "Begin a new file every so many minutes")
        ->check(isPositive())
        ->group(group);
    addStorageOptions(app, o, words, group);
}

void addOtherOptions(CLI::App& app, GrabberOptions& o, Words& words)
{
    app.add_flag("--list", words.list, "Show cameras, their modes and abilities")->group("Show");
    app.add_option("--preview", o.preview, "Renew this PNG picture every second")
        ->type_name("FILE")
        ->group("Show");
    app.add_flag("--quiet", o.quiet, "Show no status line")->group("Show");
    app.add_flag("--live", o.live, "Run the odometry on the stream; print a line per frame")
        ->group("Live odometry");
    app.add_option(
           "--live-config", o.liveOdometry.config, "With --live: configuration of the odometry")
        ->type_name("FILE")
        ->group("Live odometry");
    app.add_option(
           "--live-mask",
           o.liveOdometry.mask,
           "With --live: image that is black (darker than half of its brightest) where the camera "
           "sees "
           "the robot itself: that is left out")
        ->type_name("FILE")
        ->group("Live odometry");
    app.add_option(
           "--live-output",
           o.liveOdometry.poseRawlog,
           "With --live: write a rawlog with its pose PDFs")
        ->type_name("FILE")
        ->group("Live odometry");
}

VideoMode parseMode(const std::string& text)
{
    VideoMode mode;
    int used = 0;
    const int fields =
        std::sscanf(text.c_str(), "%9dx%9d@%9d%n", &mode.width, &mode.height, &mode.fps, &used);
    if (fields != 3 || static_cast<std::size_t>(used) != text.size() || mode.width <= 0 ||
        mode.height <= 0 || mode.fps <= 0)
    {
        throw InputError("--mode '" + text + "' is not of the form 640x480@30");
    }
    return mode;
}

void understand(const Words& words, GrabberOptions& o)
{
    const std::map<std::string, RegistrationChoice> registrations{
        {"auto", RegistrationChoice::Auto},
        {"on", RegistrationChoice::On},
        {"off", RegistrationChoice::Off}};
    o.camera.mode = parseMode(words.mode);
    o.camera.registration = registrations.at(words.registration);
    o.waitSeconds = parseFinite(words.wait).value_or(0);
    o.recording.path = o.output;
    o.recording.splitAfter = 60.0 * words.splitMinutes;
    o.recording.encoding.storage =
        words.images == "external" ? ImageStorage::External : ImageStorage::Embedded;
    if (o.output.empty() && !o.live && o.preview.empty())
    {
        throw InputError("nothing to do: give -o FILE.rawlog, --live, --preview or --list");
    }
    if (o.camera.depthOnly && o.camera.registration == RegistrationChoice::On)
    {
        throw InputError(
            "--depth-only has no colour to register depth to: not with --registration on");
    }
    const LiveOptions& live = o.liveOdometry;
    if (!o.live && !(live.config + live.mask + live.poseRawlog).empty())
    {
        throw InputError("--live-config, --live-mask and --live-output need --live");
    }
    const bool isRawlog = std::filesystem::path(o.output).extension() == ".rawlog";
    if (!o.output.empty() && !isRawlog && !o.recordsOni())
    {
        throw InputError("-o '" + o.output + "' must end in .rawlog or .oni");
    }
}

/** Options that only a rawlog obeys must not be ignored. */
void requireRawlogFor(const CLI::App& app, const GrabberOptions& o)
{
    std::vector<std::string> names{
        "--images", "--compression", "--jpeg", "--queue", "--threads", "--split-minutes"};
    if (!o.live)
    {
        names.insert(names.end(), {"--label", "--calibration", "--section"});
    }
    for (const std::string& name : names)
    {
        if (o.recordsOni() && app.count(name) > 0)
        {
            throw InputError(name + " is for a rawlog, not for '" + o.output + "'");
        }
    }
}

std::string versionText()
{
    std::string text = std::string(POINTPLANE_VERSION) + ", drivers:";
    for (const auto& name : builtInDrivers())
    {
        text += " " + name;
    }
    return text;
}
}  // namespace

int runGrabber(const std::vector<std::string>& args, std::ostream& out, std::ostream& err)
{
    CLI::App app{
        "Records an RGB-D camera to an MRPT rawlog of CObservation3DRangeScan.",
        "pointplane-grabber"};
    app.set_version_flag("--version", versionText());
    GrabberOptions options;
    Words words;
    addCameraOptions(app, options, words);
    addRecordingOptions(app, options, words);
    addOtherOptions(app, options, words);
    return runCommand(
        app,
        args,
        out,
        err,
        [&]
        {
            if (words.list || options.live)
            {
                requireStandardOutput();
            }
            if (words.list)
            {
                return listCameras(makeCameraDrivers(options.driver), out, err);
            }
            understand(words, options);
            requireRawlogFor(app, options);
            return GrabberRun(options, out, err).run();
        });
}
}  // namespace pointplane
