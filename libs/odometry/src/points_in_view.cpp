// SPDX-License-Identifier: BSD-3-Clause
#include "points_in_view.h"

namespace pointplane
{
int numInView(
    const Reference& reference, const PinholeCamera& camera, const Eigen::Isometry3d& T_cur_ref)
{
    int out = 0;
    for (size_t i = 0; i < reference.points.points.size(); ++i)
    {
        const Eigen::Vector3d p_cur = T_cur_ref * reference.points.points[i].p_cam.mean;
        if (reference.points.isDue(i) && p_cur.z() > 0)
        {
            const Eigen::Vector2d uv_px = camera.project(p_cur);
            out += uv_px.x() >= 0 && uv_px.y() >= 0 && uv_px.x() < camera.width &&
                   uv_px.y() < camera.height;
        }
    }
    return out;
}

bool areNearEdge(
    const std::vector<Association>& associations,
    const PinholeCamera& camera,
    const Eigen::Isometry3d& T_cur_world,
    double radius_px)
{
    size_t found = 0, far = 0;
    for (const Association& association : associations)
    {
        const Reference& reference = *association.reference;
        const Eigen::Isometry3d T_cur_ref = T_cur_world * reference.T_world_cam;
        for (const PointTrack& track : association.points)
        {
            const auto& point = reference.points.points[static_cast<size_t>(track.ref)];
            const Eigen::Vector2d sought_px = camera.project(T_cur_ref * point.p_cam.mean);
            far += (sought_px - track.cur.uv_px).norm() > radius_px / 2;
        }
        found += association.points.size();
    }
    return far > 0 && 2 * far >= found;
}
}  // namespace pointplane
