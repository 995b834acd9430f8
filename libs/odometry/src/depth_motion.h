// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/MovingRegions.h>
#include <pointplane/odometry/uncertainty/CameraCalibrator.h>
#include <pointplane/pose/MotionGaussian.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <Eigen/Geometry>

#include <vector>

#include "Reference.h"
#include "Track.h"

namespace pointplane
{
/** How the depth image of a reference lies to the current one's. Each is exposed somewhat before or
 * after its colour image, of which poses are. */
struct DepthMotion
{
    Eigen::Isometry3d T_cur_ref;  //!< between the cameras when their depth images were exposed
    double slack_m;               //!< by stamps that are off, of surfaces across the view
    double slackShare;            //!< and of surfaces aslant, in proportion to depth
};

/** \param motion of the current frame, from the track's previous one */
[[nodiscard]] DepthMotion depthMotion(
    const Track& track,
    const Reference& reference,
    const RgbdFrame& current,
    const Motion& motion,
    const CameraCalibrator& camera);

/** The references that have depth images, for findMovingRegions(). */
[[nodiscard]] std::vector<EarlierView> earlierViews(
    const Track& track,
    const RgbdFrame& current,
    const Motion& motion,
    const CameraCalibrator& camera);
}  // namespace pointplane
