// SPDX-License-Identifier: BSD-3-Clause
#include "surfaces.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

namespace pointplane
{
int planeAt(const Eigen::Vector2d& depthUv_px, const PlaneSet& planes)
{
    const cv::Point pixel(
        static_cast<int>(std::lround(depthUv_px.x())),
        static_cast<int>(std::lround(depthUv_px.y())));
    const bool isInside = cv::Rect({}, planes.labels.size()).contains(pixel);
    return isInside ? planes.labels.at<std::uint8_t>(pixel) - 1 : -1;
}

std::vector<InlierRatio> rememberedInliers(
    const std::vector<Association>& associations, const Features& current, double memory)
{
    std::vector<InlierRatio> out(current.planes.planes.size());
    std::vector<bool> isKnown(out.size(), false);
    for (const Association& association : associations)
    {
        const Reference& reference = *association.reference;
        const double fading = std::exp((reference.stamp - current.frame.stamp) / memory);
        for (const std::vector<PlaneMatch>* matches :
             {&association.planes, &association.movingPlanes})
        {
            for (const PlaneMatch& match : *matches)
            {
                const auto cur = static_cast<size_t>(match.cur);
                if (!isKnown[cur] && !reference.surfaces.empty())
                {
                    const InlierRatio& past = reference.surfaces[static_cast<size_t>(match.ref)];
                    out[cur] = {fading * past.points, fading * past.inliers};
                    isKnown[cur] = true;
                }
            }
        }
    }
    return out;
}

void countMoving(
    const std::vector<Association>& associations,
    const Features& current,
    std::vector<InlierRatio>& surfaces)
{
    for (const Association& association : associations)
    {
        for (const PointTrack& track : association.movingPoints)
        {
            const Eigen::Vector2d pixel = current.frame.camera.depthPixel(track.cur.uv_px);
            const auto surface = static_cast<size_t>(planeAt(pixel, current.planes));
            if (surface < surfaces.size())
            {
                ++surfaces[surface].points;
            }
        }
    }
}

RgbdFrame stillPart(
    const Features& current, const MovingRegions& moving, const std::vector<InlierRatio>& surfaces)
{
    RgbdFrame out = current.frame;
    if (!moving.areSure())
    {
        return out;
    }
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    out.depth = out.depth.clone();
    std::set<int> reached;
    for (const cv::Rect& cell : moving.cells)
    {
        out.depth(cell).setTo(kNone);
        const Eigen::Vector2d centre(cell.x + cell.width / 2, cell.y + cell.height / 2);
        reached.insert(planeAt(centre, current.planes));
    }
    for (const int surface : reached)
    {
        const auto i = static_cast<size_t>(surface);  // on none: beyond the end
        if (i < surfaces.size() && surfaces[i].value() < 0.5)
        {
            out.depth.setTo(kNone, current.planes.labels == surface + 1);
        }
    }
    return out;
}
}  // namespace pointplane
