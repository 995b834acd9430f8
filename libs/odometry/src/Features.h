// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/PointStage.h>
#include <pointplane/planes/PlaneFeature.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <optional>

#include "ImageAligner.h"

namespace pointplane
{
/** Everything that is taken from the images of one frame. It knows nothing of other frames. */
struct Features
{
    RgbdFrame frame;  //!< its pixels are shared, not copied
    double bend{0};   //!< smooth error of depth, as a fraction of it (DepthNoise::sigmaRelative)
    bool hasDepth{true};
    bool depthIsNoise{false};  //!< it had readings, but they tell no distance: they were left out
    PlaneSet planes;
    PreparedPoints points;                             //!< ready for correspondences
    mutable std::optional<DescribedPoints> described;  //!< made when they are needed first
};
}  // namespace pointplane
