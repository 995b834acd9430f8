// SPDX-License-Identifier: BSD-3-Clause
#include "report_worst_frames.h"

#include <pointplane/evaluation/units.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include "result_output.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kWorstFrames = 4;

/** Numbers that pointplane-odometry gave to frames. */
class FrameNumbers
{
 public:
    /** \param table in the order of the recording: frames that are lost for a late stamp are not in
     * the order of stamps */
    explicit FrameNumbers(const FrameTable& table)
    {
        const std::vector<double> frames = table.column("frame");
        std::vector<std::pair<double, double>> sorted;
        for (std::size_t k = 0; k < frames.size(); ++k)
        {
            if (frames[k] >= 0)  // not NaN
            {
                sorted.emplace_back(table.stamps()[k], frames[k]);
            }
        }
        std::sort(sorted.begin(), sorted.end());
        for (const auto& [stamp, frame] : sorted)
        {
            stamps_.push_back(stamp);
            frames_.push_back(static_cast<std::size_t>(frame));
        }
    }

    /** \param index of the pose, its number where there is no table */
    [[nodiscard]] std::size_t of(double stamp, std::size_t index) const
    {
        return stamps_.empty() ? index : frames_[nearestIndex(stamps_, stamp)];
    }

 private:
    std::vector<double> stamps_;
    std::vector<std::size_t> frames_;
};
}  // namespace

void addWorstFrames(
    HtmlReport& report, const ReportedRun& run, const FrameTable& table, const std::string& folder)
{
    RpeOptions frameToFrame = run.rpe;
    frameToFrame.fixedDelta = true;
    frameToFrame.delta = 1;
    frameToFrame.unit = DeltaUnit::Frames;
    frameToFrame.truthAt = TruthAt::Interpolated;
    const Trajectory truth = withBody(run.groundTruth, run.nees.T_truth_body);
    std::vector<RpePair> pairs = relativePoseError(truth, run.estimate, frameToFrame).pairs;
    std::sort(
        pairs.begin(),
        pairs.end(),
        [](const RpePair& a, const RpePair& b) { return a.translation > b.translation; });
    const FrameNumbers numbers(table);
    std::size_t numPictures = 0;
    for (const RpePair& pair : pairs)
    {
        const double stamp = run.estimate.stamps[pair.j];
        const std::size_t frame = numbers.of(stamp, pair.j);
        const std::string picture = folder + format("/%06zu.jpg", frame);
        if (numPictures == kWorstFrames || !std::filesystem::exists(picture))
        {
            continue;
        }
        ++numPictures;
        report.addPicture(
            format(
                "Frame %zu at %.2f s: motion off by %.1f mm, %.2f deg",
                frame,
                stamp - run.estimate.stamps.front(),
                1000 * pair.translation,
                kDegreesPerRadian * pair.rotation),
            picture);
    }
    if (numPictures == 0)
    {
        throw InputError(folder + ": no picture 000001.jpg, ... of these frames is in it");
    }
}
}  // namespace pointplane
