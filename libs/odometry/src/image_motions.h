// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>

#include <Eigen/Geometry>

#include <optional>

#include "Features.h"
#include "FrontEnd.h"
#include "Reference.h"
#include "Track.h"

namespace pointplane
{
/** T_prev_cur by the points of a reference that look like the frame's, wherever they are in the
 * image. */
[[nodiscard]] std::optional<Eigen::Isometry3d> motionOfPoints(
    const FrontEnd& frontEnd,
    const Features& current,
    const Track& track,
    const Reference& reference);

/** T_prev_cur by the planes of a reference. Where planes lie alike in several places, only one may
 * be near the prediction. */
[[nodiscard]] std::optional<Eigen::Isometry3d> motionOfPlanes(
    const FrontEnd& frontEnd,
    const Features& current,
    const Track& track,
    const Reference& reference,
    const PoseGaussian& predicted);

/** Whether the camera seems to see an older key frame again: by points that look alike, and
 * surfaces that lie where these put them. */
[[nodiscard]] bool recognises(
    const FrontEnd& frontEnd, const Features& current, const Reference& place);
}  // namespace pointplane
