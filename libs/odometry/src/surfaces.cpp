// SPDX-License-Identifier: BSD-3-Clause
#include "surfaces.h"

#include <cmath>
#include <cstdint>
#include <set>

#include "no_reading.h"

namespace pointplane
{
namespace
{
/** Whether most points on a surface disagree with the camera's motion. */
bool hasMoved(const InlierRatio& surface) { return surface.value() < kCountingWeight; }

/** Planes of a reference that those of the frame that have moved are matched with. */
std::set<int> movedOf(const Association& association, const std::vector<InlierRatio>& surfaces)
{
    std::set<int> out;
    for (const std::vector<PlaneMatch>* matches : {&association.planes, &association.movingPlanes})
    {
        for (const PlaneMatch& match : *matches)
        {
            const auto cur = static_cast<size_t>(match.cur);
            if (cur < surfaces.size() && hasMoved(surfaces[cur]))
            {
                out.insert(match.ref);
            }
        }
    }
    return out;
}
}  // namespace

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

RgbdFrame withoutMoved(const Features& current, const std::vector<InlierRatio>& surfaces)
{
    RgbdFrame out = current.frame;
    for (size_t i = 0; i < surfaces.size(); ++i)
    {
        if (hasMoved(surfaces[i]))
        {
            out.depth = out.depth.data == current.frame.depth.data ? out.depth.clone() : out.depth;
            out.depth.setTo(kNoReading, current.planes.labels == static_cast<int>(i) + 1);
        }
    }
    return out;
}

std::shared_ptr<const SurfaceSamples> stillSamples(
    const Association& association, const std::vector<InlierRatio>& surfaces)
{
    const Reference& reference = *association.reference;
    if (!reference.images)
    {
        return {};
    }
    const SurfaceSamples& all = reference.images->surface;
    const std::set<int> moved = movedOf(association, surfaces);
    if (moved.empty())
    {
        return {reference.images, &all};  // not copied
    }
    const PinholeCamera& camera = reference.images->frame.camera;
    auto out = std::make_shared<SurfaceSamples>();
    for (const Eigen::Vector3f& point : all.points_cam)
    {
        const Eigen::Vector3d p = point.cast<double>();
        const Eigen::Vector2d pixel(
            camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy);
        if (moved.count(planeAt(pixel, reference.planes)) == 0)
        {
            out->points_cam.push_back(point);
        }
    }
    return out;
}

RgbdFrame stillPart(
    const Features& current, const MovingRegions& moving, const std::vector<InlierRatio>& surfaces)
{
    RgbdFrame out = current.frame;
    if (!moving.areSure())
    {
        return out;
    }
    out.depth = out.depth.clone();
    std::set<int> reached;
    for (const cv::Rect& cell : moving.cells)
    {
        out.depth(cell).setTo(kNoReading);
        const Eigen::Vector2d centre(cell.x + cell.width / 2, cell.y + cell.height / 2);
        reached.insert(planeAt(centre, current.planes));
    }
    for (const int surface : reached)
    {
        const auto i = static_cast<size_t>(surface);  // on none: beyond the end
        if (i < surfaces.size() && hasMoved(surfaces[i]))
        {
            out.depth.setTo(kNoReading, current.planes.labels == surface + 1);
        }
    }
    return out;
}
}  // namespace pointplane
