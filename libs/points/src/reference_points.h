// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/points/PointTracker.h>

namespace pointplane
{
/** Takes the corners of a frame (Shi & Tomasi 1994, in the image at half its size) that have depth,
 * the strongest first; where they are fewer than minPoints, points on edges, too.
 * \pre the frame has an image */
[[nodiscard]] PointReference referencePoints(
    const RgbdFrame& frame, const PointTracker::TParams& params, const PointLifter& lifter);
}  // namespace pointplane
