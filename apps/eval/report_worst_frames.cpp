// SPDX-License-Identifier: BSD-3-Clause
#include "report_worst_frames.h"

#include <pointplane/evaluation/units.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "result_output.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kWorstFrames = 4;

/** \throws InputError saying why it is none */
void requireFolder(const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::is_directory(path, error))
    {
        throw InputError(
            "cannot open " + path + ": " + (error ? error.message() : "is not a folder"));
    }
}
}  // namespace

FramePictures picturesOf(
    const Trajectory& estimate,
    const FrameTable& table,
    const std::string& tablePath,
    const std::string& folder)
{
    requireFolder(folder);
    const std::vector<double> frames = table.column("frame");
    if (frames.empty())
    {
        throw InputError(tablePath + ":1: no column 'frame', which tells the pictures' names");
    }
    FramePictures out;
    const Trajectory measured = withoutLost(estimate);
    for (const auto& [pose, row] : rowsOf(measured.stamps, table))
    {
        if (!(frames[row] >= 0))  // NaN
        {
            continue;
        }
        const auto frame = static_cast<std::size_t>(frames[row]);
        const std::string picture = folder + format("/%06zu.jpg", frame);
        if (std::filesystem::exists(picture))
        {
            out[measured.stamps[pose]] = {frame, picture};
        }
    }
    if (out.empty())
    {
        throw InputError(
            folder + ": no picture 000001.jpg, ... of the frames of " + tablePath + " is in it");
    }
    return out;
}

void addWorstFrames(HtmlReport& report, const ReportedRun& run, const FramePictures& pictures)
{
    RpeOptions frameToFrame = run.rpe;
    frameToFrame.fixedDelta = true;
    frameToFrame.delta = 1;
    frameToFrame.unit = DeltaUnit::Frames;
    frameToFrame.truthAt = TruthAt::Interpolated;
    const Trajectory truth = withBody(run.groundTruth, run.nees.T_truth_body);
    const Trajectory measured = withoutLost(run.estimate);
    std::vector<RpePair> pairs = relativePoseError(truth, measured, frameToFrame).pairs;
    std::sort(
        pairs.begin(),
        pairs.end(),
        [](const RpePair& a, const RpePair& b) { return a.translation > b.translation; });
    std::size_t numPictures = 0;
    for (const RpePair& pair : pairs)
    {
        const auto found = pictures.find(measured.stamps[pair.j]);
        if (numPictures == kWorstFrames || found == pictures.end())
        {
            continue;
        }
        ++numPictures;
        report.addPicture(
            format(
                "Frame %zu at %.2f s: motion off by %.1f mm, %.2f deg",
                found->second.frame,
                found->first - run.estimate.stamps.front(),
                1000 * pair.translation,
                kDegreesPerRadian * pair.rotation),
            found->second.path);
    }
    if (numPictures == 0)
    {
        throw std::runtime_error("none is of a frame that has ground truth");
    }
}
}  // namespace pointplane
