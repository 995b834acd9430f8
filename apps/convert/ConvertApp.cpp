// SPDX-License-Identifier: BSD-3-Clause
#include "ConvertApp.h"

#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <filesystem>
#include <ostream>
#include <system_error>

#include "FolderRecording.h"
#include "OutputGuard.h"
#include "TextOutput.h"
#include "convert_options.h"
#include "convert_recording.h"
#include "own_ground_truth.h"
#include "run_program.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
namespace
{
void addOutputs(const RecordingOutput& output, OutputGuard& guard)
{
    guard.addRawlog("-o", output.path);
    if (output.external)
    {
        guard.addFolderBeside("images of -o", output.path, imagesFolderOf(output.path));
    }
}

/** A file with the name of the ground truth that this run did not write: not this recording's. */
void warnOfEarlierTruth(const std::string& truth, std::ostream& err)
{
    std::error_code error;
    if (std::filesystem::exists(truth, error))
    {
        err << "pointplane-convert: warning: " << truth
            << " was there before and is not of this recording; remove it if it is of another\n";
    }
}

/** \return what became of it, for people */
std::string writeTruth(const RecordingOutput& output, const std::string& truth)
{
    if (!hasPlaceBeside(output.path))
    {
        return output.path + ": is not a file; the ground truth was not written";
    }
    TextOutput file(groundTruthOf(output.path));
    file.write(truth);
    file.close();
    return file.path() + ": ground truth";
}

/** With the ground truth that comes with the images. \param guard with all inputs */
int convert(
    Recording& recording,
    const RecordingOutput& output,
    OutputGuard& guard,
    std::ostream& out,
    std::ostream& err)
{
    const std::string poses = recording.groundTruth(), truth = kCopiedTruth + poses;
    addOutputs(output, guard);
    if (!poses.empty())
    {
        guard.addGroundTruth(output.path, truth);
    }
    const RecordingSummary summary = convertRecording(recording, output, err);
    std::vector<std::string> notes = recording.notes();
    if (!poses.empty())
    {
        notes.push_back(writeTruth(output, truth));
    }
    else if (hasPlaceBeside(output.path))
    {
        warnOfEarlierTruth(groundTruthOf(output.path), err);
    }
    return report(summary, output, notes, out, err);
}

int convertByCommand(
    const CLI::App& app, const ConvertOptions& options, std::ostream& out, std::ostream& err)
{
    OutputGuard guard;
    if (app.got_subcommand("folder"))
    {
        FolderRecording recording(options.folder);
        guard.addInputFolder(options.folder.folder);
        guard.addInput(options.folder.camera);
        return convert(recording, options.output, guard, out, err);
    }
    if (app.got_subcommand("klg"))
    {
        KlgRecording recording(options.klg);
        guard.addInput(options.klg.file);
        guard.addInput(options.klg.camera);
        return convert(recording, options.output, guard, out, err);
    }
    if (app.got_subcommand("bag"))
    {
        const auto recording = openBag(options.bag);
        guard.addInput(options.bag.file);
        guard.addInput(options.bag.camera);
        return convert(*recording, options.output, guard, out, err);
    }
    TumRecording recording(options.tum);
    for (const std::string& file : recording.files())
    {
        guard.addInput(file);
    }
    return convert(recording, options.output, guard, out, err);
}
}  // namespace

int runConvert(const std::vector<std::string>& args, std::ostream& out, std::ostream& err)
{
    CLI::App app{
        "Converts RGB-D recordings to MRPT rawlogs. Pixels and depth of 16 bit stay as they are.",
        "pointplane-convert"};
    app.set_version_flag("--version", POINTPLANE_VERSION);
    app.require_subcommand(1);
    ConvertOptions options;
    addConvertCommands(app, options);
    return runCommand(
        app, args, out, err, [&] { return convertByCommand(app, options, out, err); });
}
}  // namespace pointplane
