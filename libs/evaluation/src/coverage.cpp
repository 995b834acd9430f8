// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/counted.h>
#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/coverage.h>
#include <pointplane/evaluation/stamp_intervals.h>

#include <algorithm>
#include <iterator>

namespace pointplane
{
namespace
{
struct Frame
{
    double stamp;
    bool tracked;
};

/** All frames of the recording, those without a pose too, in order of time. */
std::vector<Frame> framesOf(const Trajectory& estimate)
{
    std::vector<Frame> frames;
    for (std::size_t i = 0; i < estimate.size(); ++i)
    {
        frames.push_back(
            {estimate.stamps[i],
             estimate.status.empty() || estimate.status[i] == FrameStatus::Tracked});
    }
    for (const double stamp : estimate.lostStamps)
    {
        frames.push_back({stamp, false});
    }
    std::sort(
        frames.begin(),
        frames.end(),
        [](const Frame& a, const Frame& b) { return a.stamp < b.stamp; });
    return frames;
}

/** The time of the ground truth, without its holes. */
class KnownTime
{
 public:
    explicit KnownTime(const Trajectory& truth) : stamps_(truth.stamps), isHole_(holesBefore(truth))
    {
        for (std::size_t k = 1; k < stamps_.size(); ++k)
        {
            const double interval = stamps_[k] - stamps_[k - 1];
            holes_.push_back(holes_.back() + (isHole_[k] ? interval : 0));
            whole_ += isHole_[k] ? 0 : interval;
        }
    }

    /** \return seconds of it in an interval */
    [[nodiscard]] double within(double from, double to) const
    {
        from = std::max(from, stamps_.front());
        to = std::min(to, stamps_.back());
        return std::max(0.0, to - from - (holesBy(to) - holesBy(from)));
    }
    [[nodiscard]] double whole() const { return whole_; }

 private:
    /** Seconds of holes up to a time. */
    [[nodiscard]] double holesBy(double time) const
    {
        const auto next = std::upper_bound(stamps_.begin(), stamps_.end(), time);
        const auto k = static_cast<std::size_t>(next - stamps_.begin());
        if (k == 0 || k == stamps_.size())
        {
            return k == 0 ? 0 : holes_.back();
        }
        return holes_[k - 1] + (isHole_[k] ? time - stamps_[k - 1] : 0);
    }

    const std::vector<double>& stamps_;
    std::vector<bool> isHole_;
    std::vector<double> holes_{0};  //!< seconds of holes up to each pose
    double whole_{0};
};

void countFrames(const Trajectory& estimate, Coverage& out)
{
    const auto count = [&](FrameStatus status)
    {
        return static_cast<std::size_t>(
            std::count(estimate.status.begin(), estimate.status.end(), status));
    };
    out.predicted = count(FrameStatus::Predicted);
    out.lost = count(FrameStatus::Lost);
    out.tracked = estimate.size() - out.predicted - out.lost;
    out.lost += estimate.lostStamps.size() + estimate.lostWithoutTime;
}
}  // namespace

Coverage coverageOf(const Trajectory& groundTruth, const Trajectory& estimate, double offset)
{
    const std::vector<Frame> frames = framesOf(estimate);
    std::vector<double> stamps;
    std::transform(
        frames.begin(),
        frames.end(),
        std::back_inserter(stamps),
        [](const Frame& frame) { return frame.stamp; });
    const double longest = longestStep(stamps);
    const KnownTime truth(groundTruth);
    double seconds = 0;
    double steps = 0;
    for (std::size_t i = 1; i < frames.size(); ++i)
    {
        const double interval = stamps[i] - stamps[i - 1];
        if (frames[i].tracked && interval > 0 && interval <= longest)
        {
            const double known = truth.within(stamps[i - 1] + offset, stamps[i] + offset);
            seconds += known;
            steps += known / interval;
        }
    }
    Coverage out;
    out.ofRecording = estimate.marksFrames;
    // Steps of a recording, not its time, of which one wrong stamp would make years.
    const double counted = out.ofRecording ? steps : seconds;
    const double whole = out.ofRecording
                             ? static_cast<double>(frames.size() + estimate.lostWithoutTime) - 1
                             : truth.whole();
    out.share = whole > 0 ? std::min(1.0, counted / whole) : 0;
    out.ofTruth = truth.whole() > 0 ? std::min(1.0, seconds / truth.whole()) : 0;
    countFrames(estimate, out);
    return out;
}

std::string describe(const Coverage& coverage)
{
    const std::string out =
        "coverage " + numberText(100 * coverage.share, 1) +
        (coverage.ofRecording ? " % of the recording: " + counted(coverage.tracked, "frame") +
                                    " tracked, " + std::to_string(coverage.predicted) +
                                    " predicted, " + std::to_string(coverage.lost) + " lost"
                              : " % of the ground truth's time, frames not marked");
    // Ground truth often begins a little before the recording, and ends a little after it.
    const bool isPart = coverage.ofRecording && coverage.ofTruth < 0.9 * coverage.share;
    return out +
           (isPart ? "; " + numberText(100 * coverage.ofTruth, 1) + " % of the ground truth's time"
                   : std::string());
}
}  // namespace pointplane
