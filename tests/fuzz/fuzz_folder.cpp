// SPDX-License-Identifier: BSD-3-Clause
// Any files in a folder, as `pointplane-convert folder` and `tum` take it.
#include <pointplane/mrpt_io/errors.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "FolderRecording.h"
#include "TumRecording.h"
#include "convert_recording.h"
#include "folder_archive.h"
#include "fuzzing.h"

namespace
{
using namespace pointplane;
namespace fs = std::filesystem;

/** Looks at what it passes on. */
class CheckedRecording : public Recording
{
 public:
    explicit CheckedRecording(Recording& recording) : recording_(recording) {}

    std::optional<RecordedFrame> next() override
    {
        try
        {
            auto frame = recording_.next();
            fuzzing::require(progress() >= 0 && progress() <= 1, "a progress from 0 to 1");
            if (frame)
            {
                check(*frame);
            }
            return frame;
        }
        catch (const BadFrame& error)
        {
            fuzzing::requireOneLine(oneLine(error));
            throw;
        }
    }
    [[nodiscard]] double progress() const override { return recording_.progress(); }
    [[nodiscard]] std::string damage() const override { return recording_.damage(); }
    [[nodiscard]] std::vector<std::string> notes() const override { return recording_.notes(); }

 private:
    static void check(const RecordedFrame& frame)
    {
        const RegisteredScan& scan = frame.scan;
        const PinholeCamera& camera = scan.camera;
        const PinholeCamera& depth = scan.depthCamera ? scan.depthCamera->camera : camera;
        fuzzing::require(camera.problem().empty() && depth.problem().empty(), "usable cameras");
        fuzzing::require(
            scan.colour.size() == cv::Size(camera.width, camera.height), "colour of its camera");
        fuzzing::require(
            scan.depth.size() == cv::Size(depth.width, depth.height), "depth of its camera");
        fuzzing::require(scan.depth.type() == CV_16UC1, "16 bit of depth");
        fuzzing::require(scan.unitsPerMetre > 0, "positive units");
    }

    Recording& recording_;
};

template <class Reader, class Options>
void convert(const std::string& folder)
{
    try
    {
        Options options;
        options.folder = folder;
        Reader reader(options);
        CheckedRecording recording(reader);
        RecordingOutput output;
        output.path = "/dev/null";
        output.quiet = true;
        std::ostringstream out, err;
        const RecordingSummary summary = convertRecording(recording, output, err);
        fuzzing::require(summary.numFrames > 0, "a recording has frames");
        (void)report(summary, output, recording.notes(), out, err);
        for (const std::string& note : recording.notes())
        {
            fuzzing::requireOneLine(note);
        }
    }
    catch (const InputError& error)
    {
        fuzzing::requireOneLine(oneLine(error));
    }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const fuzzing::ArchiveFolder folder;
    folder.fill(std::string(reinterpret_cast<const char*>(data), size));
    convert<FolderRecording, FolderOptions>(folder.path());
    convert<TumRecording, TumOptions>(folder.path());
    return 0;
}
