// SPDX-License-Identifier: BSD-3-Clause
#include "image_motions.h"

#include "Judge.h"

namespace pointplane
{
namespace
{
/** T_prev_cur of a motion from a reference. */
Eigen::Isometry3d toCurrent(
    const Track& track, const Reference& reference, const Eigen::Isometry3d& T_cur_ref)
{
    return track.previous().T_world_cam.inverse() * reference.T_world_cam * T_cur_ref.inverse();
}
}  // namespace

std::optional<Eigen::Isometry3d> motionOfPoints(
    const FrontEnd& frontEnd,
    const Features& current,
    const Track& track,
    const Reference& reference)
{
    const auto motion = frontEnd.alignImages(reference, current);
    return motion ? std::optional(toCurrent(track, reference, *motion)) : std::nullopt;
}

std::optional<Eigen::Isometry3d> motionOfPlanes(
    const FrontEnd& frontEnd,
    const Features& current,
    const Track& track,
    const Reference& reference,
    const PoseGaussian& predicted)
{
    std::optional<Eigen::Isometry3d> out;
    for (const Eigen::Isometry3d& T_cur_ref : frontEnd.alignPlanes(reference, current))
    {
        const Eigen::Isometry3d T_prev_cur = toCurrent(track, reference, T_cur_ref);
        if (Judge::isSurprising(T_prev_cur, predicted))
        {
            continue;
        }
        if (out)
        {
            return {};
        }
        out = T_prev_cur;
    }
    return out;
}

bool recognises(const FrontEnd& frontEnd, const Features& current, const Reference& place)
{
    const auto motion = frontEnd.alignImages(place, current);
    return motion && Judge::areConvincing(frontEnd.compare(place, current, *motion));
}
}  // namespace pointplane
