// SPDX-License-Identifier: BSD-3-Clause
#include "depth_motion.h"

#include <pointplane/core/se3.h>

namespace pointplane
{
namespace
{
/** The camera's motion while it waited for the depth image. */
Eigen::Isometry3d untilDepth(const Vector6d& velocity, double delay)
{
    return se3Exp(delay * velocity);
}
}  // namespace

DepthMotion depthMotion(
    const Track& track,
    const Reference& reference,
    const RgbdFrame& current,
    const Motion& motion,
    const CameraCalibrator& camera)
{
    const Eigen::Isometry3d T_cur_ref = track.fromWorld(motion.T_prev_cur) * reference.T_world_cam;
    const Eigen::Isometry3d T_depth_cur =
        untilDepth(motion.velocity, camera.complete(current.shutter).depthDelay).inverse();
    const Vector6d ofReference = reference.velocity.value_or(motion.velocity);
    const Eigen::Isometry3d T_ref_depth =
        untilDepth(ofReference, camera.complete(reference.shutter).depthDelay);
    const double speed = motion.velocity.head<3>().norm() + ofReference.head<3>().norm();
    const double rate = motion.velocity.tail<3>().norm() + ofReference.tail<3>().norm();
    const double time = camera.sigmaPrior();
    return {T_depth_cur * T_cur_ref * T_ref_depth, time * speed, time * rate};
}

std::vector<EarlierView> earlierViews(
    const Track& track,
    const RgbdFrame& current,
    const Motion& motion,
    const CameraCalibrator& camera)
{
    std::vector<EarlierView> out;
    for (const Reference* reference : track.references())
    {
        if (reference->images)
        {
            const DepthMotion depth = depthMotion(track, *reference, current, motion, camera);
            out.push_back(
                {&reference->images->frame,
                 depth.T_cur_ref.inverse(),
                 depth.slack_m,
                 depth.slackShare});
        }
    }
    return out;
}
}  // namespace pointplane
