// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/RawlogReader.h>

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "OdometryOptions.h"
#include "OutputGuard.h"

namespace pointplane
{
/** One observation of the input; with a frame if it is of the camera in question. */
struct SourceItem
{
    mrpt::obs::CObservation::Ptr observation;
    std::shared_ptr<RawlogRecord>
        record;  //!< the observation as it is in the file, if it may stay so
    std::optional<ConvertedFrame> converted;
    std::string tellsOf;        //!< a comment about this camera
    std::size_t frameIndex{0};  //!< in the input, counted over RGB-D frames of the camera
    double progress{0};         //!< fraction of the input read, 0 to 1
};

/** Observation after observation of the input rawlogs, formats 1 and 2, as one sequence; those of
 * the camera are converted. Observations before the first frame wanted are left out, except the
 * comments about cameras that hold for it, and what an earlier run has written about this camera.
 */
class FrameSource
{
 public:
    /** \param guard knows all outputs: none of them may be a file that a rawlog refers to
     * \throws InputError if one of the rawlogs cannot be read */
    FrameSource(const OdometryOptions& options, const OutputGuard& guard);

    /** Nothing at the end: of the input, of the frames wanted, or at damage (see damage()), which
     * a comment about a camera can be, too. */
    [[nodiscard]] std::optional<SourceItem> next();

    /** One line; empty if the input was read to its end. */
    [[nodiscard]] const std::string& damage() const { return damage_; }
    [[nodiscard]] const std::string& label() const { return label_; }
    /** One line, if next() gave no frame: what is in the input instead. */
    [[nodiscard]] std::string whyNoFrames() const;
    /** Lines about what was read and not used. */
    [[nodiscard]] std::vector<std::string> notes() const;
    /** When the frames before the first one wanted had been read: the time per frame is without
     * them. */
    [[nodiscard]] std::chrono::steady_clock::time_point start() const { return start_; }

 private:
    void openNext();
    bool refill();
    void checkExternals(const mrpt::obs::CObservation3DRangeScan& scan) const;
    [[nodiscard]] static bool isMark(const mrpt::obs::CObservation& observation);
    [[nodiscard]] bool isOfEarlierRun(const mrpt::obs::CObservation& observation) const;
    void endAt(const std::string& damage);
    /** Nothing if there is damage in it. */
    [[nodiscard]] std::optional<SourceItem> item(const mrpt::obs::CObservation::Ptr& observation);
    /** Converts the scan, if it is of the camera in question and not before the first frame. */
    void addFrame(mrpt::obs::CObservation3DRangeScan& scan, SourceItem& out);
    [[nodiscard]] bool hasAllFrames() const;
    void skip(SourceItem item);
    void deliver(SourceItem item);

    const OdometryOptions& options_;
    const OutputGuard& guard_;
    std::size_t nextInput_{0};
    std::unique_ptr<RawlogReader> reader_;
    ObservationConverter converter_;
    std::deque<mrpt::obs::CObservation::Ptr> pending_;
    bool pendingIsObject_{false};  //!< not out of a sensory frame
    std::deque<SourceItem> ready_;
    std::map<std::string, SourceItem> skippedComments_;  //!< the latest about each camera
    std::string label_;
    std::map<std::string, std::size_t> framesOf_;     //!< their number, of each camera by its label
    bool isNominal_{false};                           //!< the recording says so of its camera
    std::map<std::string, std::size_t> notPassedOn_;  //!< objects by class
    std::size_t numReplaced_{0};                      //!< observations of an earlier run
    std::size_t numFrames_{0};
    std::string damage_;
    std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
};
}  // namespace pointplane
