// SPDX-License-Identifier: BSD-3-Clause
#include "SequenceWriter.h"

#include <pointplane/mrpt_io/ImagesFolder.h>
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/ScanWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/image_file.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <optional>
#include <thread>

#include "OutputGuard.h"
#include "ProgressBar.h"
#include "TextOutput.h"
#include "own_ground_truth.h"
#include "tum_line.h"

namespace pointplane
{
namespace
{
/** Frames in order, rendered ahead by as many threads as there are processors. */
class Renderers
{
 public:
    explicit Renderers(const SimulatedSequence& sequence) : sequence_(sequence) {}

    [[nodiscard]] RegisteredScan next()
    {
        const std::size_t ahead = std::max(1U, std::thread::hardware_concurrency());
        while (running_.size() < ahead && started_ < sequence_.numFrames())
        {
            const int frame = started_++;
            running_.push_back(
                std::async(std::launch::async, [this, frame] { return render(frame); }));
        }
        RegisteredScan out = running_.front().get();
        running_.pop_front();
        return out;
    }

 private:
    [[nodiscard]] RegisteredScan render(int index) const
    {
        RegisteredScan out;
        const RgbdFrame frame = sequence_.frame(index, &out.colour);
        out.stamp = fromSeconds(frame.stamp);
        out.camera = frame.camera;
        out.depth = depthInUnits(frame.depth, out.unitsPerMetre);
        return out;
    }

    const SimulatedSequence& sequence_;
    std::deque<std::future<RegisteredScan>> running_;
    int started_{0};
};

/** Whether a file may be one of writeMasks(), complete or not: a number as its name, eight bits of
 * grey. */
[[nodiscard]] bool isMask(const std::filesystem::path& path)
{
    const std::string name = path.filename().string();
    const std::string rest =
        name.substr(std::min(name.size(), name.find_first_not_of("0123456789")));
    constexpr std::size_t kBits = 24, kColours = 25, kHead = 26;  // of a PNG, all bytes before
    char head[kHead] = {};
    std::ifstream(path, std::ios::binary).read(head, sizeof head);
    return rest.size() < name.size() &&
           (rest == ".png.partial" || (rest == ".png" && head[kBits] == 8 && head[kColours] == 0));
}

/** One picture a frame, of the colour image's pixels: 0 = the still world, i + 1 = mover i. */
void writeMasks(const SimulatedSequence& sequence, const std::string& folder)
{
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        char name[32];
        std::snprintf(name, sizeof name, "/%06d.png", i);
        writeImageFile(folder + name, sequence.trueMovers(i).labels);
    }
}

[[nodiscard]] std::string groundTruthText(
    const SimulatedSequence& sequence, const SequenceOutput& output)
{
    const bool robot = output.truthFrame == "robot";
    std::string text = kRenderedTruth;
    text += robot ? "robot, axes x forward, y left, z up; its camera has sensorPose = identity\n"
                  : "camera, optical axes x right, y down, z forward\n";
    text += "# stamp tx ty tz qx qy qz qw\n";
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        const double stamp = sequence.stamp(i);
        const Eigen::Isometry3d T_world_cam = sequence.truth(stamp);
        text += tumLine(
            fromSeconds(stamp), robot ? T_world_cam * opticalInBody().inverse() : T_world_cam);
        text += "\n";
    }
    return text;
}

/** Before anything is written. */
void guardOutputs(const SequenceOutput& output, const std::string& truth)
{
    OutputGuard guard;
    guard.addRawlog("-o", output.path);
    guard.addGroundTruth(output.path, truth);
    if (output.external)
    {
        guard.addFolderBeside("images of -o", output.path, imagesFolderOf(output.path));
    }
    if (output.masks)
    {
        guard.addFolderBeside("masks of -o", output.path, masksFolderOf(output.path));
    }
}

/** Where masks go, if they are asked for. After the rawlog: who writes that has them to himself. */
[[nodiscard]] std::unique_ptr<ImagesFolder> openMasks(
    const SequenceOutput& output, ScanWriter& writer)
{
    try
    {
        return !output.masks
                   ? nullptr
                   : std::make_unique<ImagesFolder>(
                         masksFolderOf(output.path), OwnImages{"mask of what moves", isMask});
    }
    catch (...)
    {
        writer.discard();
        throw;
    }
}

void writeFrames(
    const SimulatedSequence& sequence,
    const SequenceOutput& output,
    ScanWriter& writer,
    std::ostream& progress)
{
    const auto start = fromSeconds(sequence.stamp(0));
    if (!output.hideShutter)
    {
        writer.writeComment(start, cameraComment(output.label, sequence.params().shutter()));
    }
    writer.writeComment(start, output.description);
    std::optional<ProgressBar> bar;
    if (!output.quiet)
    {
        bar.emplace(progress, standardErrorIsTerminal(), output.path);
    }
    Renderers renderers(sequence);
    const int numFrames = sequence.numFrames();
    for (int i = 0; i < numFrames; ++i)
    {
        writer.write(renderers.next());
        if (bar)
        {
            bar->update(static_cast<double>(i + 1) / numFrames, static_cast<std::size_t>(i) + 1);
        }
    }
}
}  // namespace

std::string masksFolderOf(const std::string& rawlog)
{
    const std::string images = imagesFolderOf(rawlog), suffix = "_Images";
    return images.substr(0, images.size() - suffix.size()) + "_Masks";
}

void writeSequence(
    const SimulatedSequence& sequence, const SequenceOutput& output, std::ostream& progress)
{
    const std::string truth = groundTruthText(sequence, output);
    guardOutputs(output, truth);
    ScanWriter writer(output.path, output.label, output.external);
    const std::unique_ptr<ImagesFolder> masks = openMasks(output, writer);
    try
    {
        writeFrames(sequence, output, writer, progress);
        if (masks)
        {
            writeMasks(sequence, masks->partialPath());
            masks->completeWith([&] { writer.close(); });
        }
        else
        {
            writer.close();
        }
        if (hasPlaceBeside(output.path))  // last: an earlier one stays with its rawlog till then
        {
            TextOutput file(groundTruthOf(output.path));
            file.write(truth);
            file.close();
        }
    }
    catch (const EnvironmentError&)
    {
        throw;  // what was written may be wanted
    }
    catch (...)
    {
        writer.discard();
        if (masks)
        {
            masks->removePartial();
        }
        throw;
    }
}
}  // namespace pointplane
