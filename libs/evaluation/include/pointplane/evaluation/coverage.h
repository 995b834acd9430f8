// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>

#include <string>

namespace pointplane
{
/** How much of a recording a score speaks for. */
struct Coverage
{
    /** Steps from frame to frame in which the camera was tracked and there is ground truth, as a
     * share in [0, 1] of the recording's. Where the recording is not known: the time of these
     * steps, as a share of the ground truth's. */
    double share{0};
    bool ofRecording{false};                        //!< Trajectory::marksFrames
    double ofTruth{0};                              //!< share of the ground truth's time
    std::size_t tracked{0}, predicted{0}, lost{0};  //!< frames; all tracked if they are not marked
};

/** A frame stands for the step from the frame before it. That counts if the frame was tracked and
 * if it is not longer than five times the median one, which is a gap. Of the ground truth's time,
 * its holesBefore() do not count.
 * \param offset added to the estimate's stamps [s] */
[[nodiscard]] Coverage coverageOf(
    const Trajectory& groundTruth, const Trajectory& estimate, double offset);

/** "coverage 38.7 % of the recording: 59 frames tracked, 0 predicted, 92 lost". Adds the share of
 * the ground truth's time if the recording's is much more: it may be a part of a longer one. */
[[nodiscard]] std::string describe(const Coverage& coverage);
}  // namespace pointplane
