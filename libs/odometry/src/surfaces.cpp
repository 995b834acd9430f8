// SPDX-License-Identifier: BSD-3-Clause
#include "surfaces.h"

#include <cmath>
#include <cstdint>

namespace pointplane
{
int surfaceAt(const Eigen::Vector2d& depthUv_px, const PlaneSet& planes)
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
            const auto surface = static_cast<size_t>(surfaceAt(pixel, current.planes));
            if (surface < surfaces.size())
            {
                ++surfaces[surface].points;
            }
        }
    }
}
}  // namespace pointplane
