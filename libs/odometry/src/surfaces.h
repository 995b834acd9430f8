// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/MovingRegions.h>
#include <pointplane/pose/InlierRatio.h>

#include <memory>
#include <vector>

#include "Features.h"
#include "Reference.h"

namespace pointplane
{
/** Which plane covers the pixel of the depth image: an index into PlaneSet::planes, or -1. */
[[nodiscard]] int planeAt(const Eigen::Vector2d& depthUv_px, const PlaneSet& planes);

/** What earlier frames tell of each plane of the current frame: how many points on it have agreed
 * with the camera's motion so far. A plane is known from the first reference that it is matched
 * with. \param memory [s] after which the points of a frame count for 1/e of what they did */
[[nodiscard]] std::vector<InlierRatio> rememberedInliers(
    const std::vector<Association>& associations, const Features& current, double memory);

/** Counts points that go with what moves (Association::movingPoints) as outliers. */
void countMoving(
    const std::vector<Association>& associations,
    const Features& current,
    std::vector<InlierRatio>& surfaces);

/** The frame without the depth of planes that have moved: most points on them have disagreed with
 * the camera's motion. What they hide and what they uncover says nothing of that.
 * \param surfaces rememberedInliers(); none: as in the paper */
[[nodiscard]] RgbdFrame withoutMoved(
    const Features& current, const std::vector<InlierRatio>& surfaces);

/** Samples of a reference that are not on a plane that has moved since; none if it kept none. */
[[nodiscard]] std::shared_ptr<const SurfaceSamples> stillSamples(
    const Association& association, const std::vector<InlierRatio>& surfaces);

/** The frame without the depth of what surely moves (MovingRegions::areSure()): of moving regions,
 * and of planes that reach into them and that most of their points contradict. */
[[nodiscard]] RgbdFrame stillPart(
    const Features& current, const MovingRegions& moving, const std::vector<InlierRatio>& surfaces);
}  // namespace pointplane
