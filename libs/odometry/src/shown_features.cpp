// SPDX-License-Identifier: BSD-3-Clause
#include "shown_features.h"

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** \param weight robust: of a point as it is, of a plane over that of the best plane, as noise of
 * all planes lowers the weights of all */
FeatureUse useOf(double weight)
{
    return weight > kCountingWeight ? FeatureUse::Used
           : weight > 0             ? FeatureUse::Doubted
                                    : FeatureUse::Rejected;
}

/** Of what several references tell of a plane, the most holds. */
void showPlane(const PlaneMatch& match, FeatureUse use, FrameFeatures& shown)
{
    FeatureUse& most = shown.planeUses.at(static_cast<size_t>(match.cur));
    most = std::min(most, use);
}

void showPoint(const PointTrack& track, FeatureUse use, FrameFeatures& shown)
{
    shown.points.push_back({track.cur.uv_px, use});
}

/** What was found again, but the pose does not depend on. */
void showLeftOut(const Association& association, FrameFeatures& shown)
{
    for (const PlaneMatch& match : association.movingPlanes)
    {
        showPlane(match, FeatureUse::Rejected, shown);
    }
    for (const auto* rejected : {&association.movingPoints, &association.fixedPoints})
    {
        for (const PointTrack& track : *rejected)
        {
            showPoint(track, FeatureUse::Rejected, shown);
        }
    }
    for (const PointTrack& track : association.doubtedPoints)
    {
        showPoint(track, FeatureUse::Doubted, shown);
    }
}
}  // namespace

FrameFeatures shownPlanes(const Features& current)
{
    FrameFeatures out;
    out.planes = current.planes;
    out.planeUses.assign(current.planes.planes.size(), FeatureUse::New);
    return out;
}

void showPairs(
    const std::vector<Association>& associations,
    const PoseAnalysis* analysis,
    FrameFeatures& shown)
{
    size_t i = 0, j = 0;  // in the order of PairBuilder
    const double bestPlane =
        analysis && !analysis->planeWeights.empty()
            ? *std::max_element(analysis->planeWeights.begin(), analysis->planeWeights.end())
            : 0;
    for (const Association& association : associations)
    {
        for (const PlaneMatch& match : association.planes)
        {
            const FeatureUse use =
                analysis ? useOf(analysis->planeWeights.at(j++) / bestPlane) : FeatureUse::Rejected;
            showPlane(match, use, shown);
        }
        for (const PointTrack& track : association.points)
        {
            const FeatureUse use =
                analysis ? useOf(analysis->pointWeights.at(i++)) : FeatureUse::Rejected;
            showPoint(track, use, shown);
        }
        showLeftOut(association, shown);
    }
}

void showNewPoints(const PointReference& reference, FrameFeatures& shown)
{
    for (const PointFeature& point : reference.points)
    {
        shown.points.push_back({point.uv_px, FeatureUse::New});
    }
}

void showEachOnce(double same_px, FrameFeatures& shown)
{
    std::vector<FrameFeatures::Point>& points = shown.points;
    const auto row = [same_px](const FrameFeatures::Point& p)
    { return std::floor(p.uv_px.y() / same_px); };
    std::sort(
        points.begin(),
        points.end(),
        [&](const auto& a, const auto& b)
        {
            return row(a) != row(b)             ? row(a) < row(b)
                   : a.uv_px.x() != b.uv_px.x() ? a.uv_px.x() < b.uv_px.x()
                                                : a.use < b.use;
        });
    auto rowAbove = points.begin(), thisRow = points.begin(), end = points.begin();  // of the kept
    double current = -1;
    for (const FrameFeatures::Point& point : points)
    {
        if (row(point) != current)
        {
            rowAbove = thisRow;
            thisRow = end;
            current = row(point);
        }
        const auto same = std::find_if(
            rowAbove,
            end,
            [&](const auto& other)
            { return (other.uv_px - point.uv_px).squaredNorm() < same_px * same_px; });
        if (same == end)
        {
            *end++ = point;
        }
        else
        {
            same->use = std::min(same->use, point.use);
        }
    }
    points.erase(end, points.end());
}

void countShown(const FrameFeatures& shown, FrameDiagnostics& diagnostics)
{
    diagnostics.numPoints = static_cast<int>(shown.points.size());
    for (const FrameFeatures::Point& point : shown.points)
    {
        diagnostics.numPointsDoubted += point.use == FeatureUse::Doubted;
        diagnostics.numPointsRejected += point.use == FeatureUse::Rejected;
    }
    diagnostics.movingShare = shown.moving.share();
}
}  // namespace pointplane
