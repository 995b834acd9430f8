// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/planes/PlaneFeature.h>
#include <pointplane/planes/PlaneMatcher.h>
#include <pointplane/points/PointTracker.h>
#include <pointplane/pose/InlierRatio.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <memory>
#include <optional>
#include <vector>

#include "ImageAligner.h"
#include "surface_agreement.h"

namespace pointplane
{
/** What is kept of a key frame's images: about 2 MB at 640 x 480. */
struct KeyframeImages
{
    RgbdFrame frame;                           //!< shares the images
    SurfaceSamples surface;                    //!< later depth images should show these points
    std::optional<DescribedPoints> described;  //!< made when they are needed first
};

/** A past frame that the current one is aligned with. */
struct Reference
{
    int id{0};        //!< number of the frame
    double stamp{0};  //!< [s]
    Eigen::Isometry3d T_world_cam{Eigen::Isometry3d::Identity()};
    /** Body velocity at stamp [m/s, rad/s]. If it is not known, that of the frame that is compared
     * with this one is taken. */
    std::optional<Vector6d> velocity;
    ShutterModel shutter;  //!< as far as the source knows it
    PlaneSet planes;
    std::vector<InlierRatio> surfaces;       //!< of the planes' points so far; empty: not known
    PointReference points;                   //!< empty for a frame that is not a key frame
    std::shared_ptr<KeyframeImages> images;  //!< of a key frame
};

/** What one reference and the current frame have in common. */
struct Association
{
    const Reference* reference{nullptr};
    std::vector<PlaneMatch> planes;
    std::vector<PointTrack> points;
    /** Found again as well, but on what moves: the pose does not depend on them. */
    std::vector<PlaneMatch> movingPlanes;
    std::vector<PointTrack> movingPoints;
    /** Found again, but the pose does not depend on them either: they are so few that they may
     * agree by chance, or they may be fixed to the image. */
    std::vector<PointTrack> doubtedPoints;
    /** Points of what is fixed to the image, like text: they count as not found. */
    std::vector<PointTrack> fixedPoints;

    [[nodiscard]] size_t numPointsFound() const
    {
        return points.size() + movingPoints.size() + doubtedPoints.size();
    }
};
}  // namespace pointplane
