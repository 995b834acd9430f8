// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/OdometryResult.h>
#include <pointplane/pose/PoseAnalysis.h>

#include <vector>

#include "Features.h"
#include "Reference.h"

namespace pointplane
{
/** The planes of a frame, compared with nothing yet. */
[[nodiscard]] FrameFeatures shownPlanes(const Features& current);

/** What became of the features that were found again.
 * \param analysis of the solution that these associations gave; null: the frame was not tracked */
void showPairs(
    const std::vector<Association>& associations,
    const PoseAnalysis* analysis,
    FrameFeatures& shown);

/** Adds the points that a frame has been given as a reference, where there is none yet. */
void showNewPoints(const PointReference& reference, FrameFeatures& shown);

/** Keeps of points of the same place that which counts most; a new one least.
 * \param same_px points that are closer are the same one */
void showEachOnce(double same_px, FrameFeatures& shown);

/** What is told in numbers of the features that are shown. */
void countShown(const FrameFeatures& shown, FrameDiagnostics& diagnostics);
}  // namespace pointplane
