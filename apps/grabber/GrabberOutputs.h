// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Preview.h>

#include <atomic>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "GrabberOptions.h"
#include "summary.h"

namespace pointplane
{
/** What is made of the images while they come: rawlog, live odometry, preview, as asked for. */
class GrabberOutputs
{
 public:
    /** \param builder must live as long as this \param out for lines of the live odometry
     * \throws InputError, EnvironmentError */
    GrabberOutputs(
        const GrabberOptions& options,
        const CameraFacts& camera,
        const ObservationBuilder& builder,
        std::ostream& out);

    /** \return false if there is no recording any more */
    [[nodiscard]] bool add(const ImagePair& pair);

    /** Whether a disk error has ended the recording. */
    [[nodiscard]] bool hasFailed() const { return writer_ && writer_->hasFailed(); }

    /** Completes all. \return what went wrong, one line each */
    [[nodiscard]] std::vector<std::string> finish();

    /** Sets what is told of the recording. */
    void describeIn(RunState& state) const;
    void describeIn(RunSummary& summary) const;

 private:
    const bool isFile_;  //!< it can wait
    const std::size_t queueCapacity_;
    std::unique_ptr<Preview> preview_;
    std::unique_ptr<LiveOdometry> live_;
    std::unique_ptr<RecordingWriter> writer_;
    std::atomic<std::uint64_t> queueDrops_{0};
};
}  // namespace pointplane
