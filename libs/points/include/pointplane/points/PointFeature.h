// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PointGaussian.h>

namespace pointplane
{
/** A key point with depth. */
struct PointFeature
{
    Eigen::Vector2d uv_px{0, 0};  //!< raw pixel, sub-pixel accurate
    PointGaussian p_cam;          //!< camera frame, optical axes [m]
};
}  // namespace pointplane
