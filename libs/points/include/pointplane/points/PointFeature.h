// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PointGaussian.h>

namespace pointplane
{
/** A point of an image, with depth as a rule. */
struct PointFeature
{
    Eigen::Vector2d uv_px{0, 0};  //!< raw pixel, sub-pixel accurate
    PointGaussian p_cam;          //!< camera frame, optical axes [m]
    bool hasDepth{true};          //!< else it is anywhere along its ray: p_cam is a guess
    int directions{2};            //!< of the image, in which it is measured: 1 on an edge
    /** The surface around it as a plane through it: theta_m . P + 1 = 0 [1/m]. */
    Eigen::Vector3d theta_m{0, 0, 0};
    /** Of a track: d p_cam / d vignetting [m], how far it is displaced by vignetting (the fraction
     * by which the image's corners are darker than its centre). */
    Eigen::Vector3d ofVignetting_m{0, 0, 0};
};
}  // namespace pointplane
