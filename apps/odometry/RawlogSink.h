// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/RawlogWriter.h>

#include <mrpt/obs/CSensoryFrame.h>

#include <string>

#include "Sink.h"

namespace pointplane
{
/** The output rawlog.
 *
 * Format 2: every input observation, followed for each frame of the camera by a
 * CObservationRobotPose with its stamp (and by those of the motions since earlier frames, labelled
 * LABEL_since_N, if asked for), and by a CObservationComment if it was not tracked. Format
 * 1: per frame a CActionCollection with the increment as CActionRobotMovement3D, and a
 * CSensoryFrame. That holds all observations until the next frame, in the first one also those
 * before it. */
class RawlogSink : public Sink
{
 public:
    explicit RawlogSink(const OdometryOptions& options);

    void add(const OutputItem& item) override;
    void close() override;
    void discard() noexcept override { writer_.discard(); }
    [[nodiscard]] std::string description() const override;

 private:
    [[nodiscard]] mrpt::obs::CObservation::Ptr observationOf(const OutputItem& item) const;
    void addFormat1(const OutputItem& item);
    void addFormat2(const OutputItem& item);
    void writeSensoryFrame();

    RawlogWriter writer_;
    bool format1_;
    bool onlyPoses_;
    int since_;
    std::size_t numFrames_{0};
    bool withPoints_;
    mrpt::obs::CSensoryFrame sensoryFrame_;  //!< of format 1, not yet written
    bool hasFrame_{false};                   //!< it has the camera's
};
}  // namespace pointplane
