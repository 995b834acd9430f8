// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Plane.h>
#include <pointplane/core/PointGaussian.h>

namespace pointplane
{
/** The same point seen twice. */
struct PointPair
{
    PointGaussian base;  //!< from a reference frame, in the base frame [m]
    PointGaussian cur;   //!< in the current camera [m]
};

/** The same plane seen twice. */
struct PlanePair
{
    PlaneGaussian base;  //!< from a reference frame, in the base frame
    PlaneGaussian cur;   //!< in the current camera
};
}  // namespace pointplane
