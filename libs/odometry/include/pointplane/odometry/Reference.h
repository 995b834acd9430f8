// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/odometry/ImageAligner.h>
#include <pointplane/odometry/Verdict.h>
#include <pointplane/planes/PlaneFeature.h>
#include <pointplane/planes/PlaneMatcher.h>
#include <pointplane/points/PointTracker.h>
#include <pointplane/pose/InlierRatio.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <memory>
#include <optional>
#include <vector>

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
    /** Body velocity at stamp [m/s, rad/s]. Unknown: as that of the frame it is compared with. */
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
    /** Found again as well, but they go with what moves: the pose does not depend on them. */
    std::vector<PlaneMatch> movingPlanes;
    std::vector<PointTrack> movingPoints;
    /** Found again, but so few that chance may have made them agree, or of what may be fixed to the
     * image: likewise. */
    std::vector<PointTrack> doubtedPoints;
    /** Points of what is fixed to the image, like text: they count as not found. */
    std::vector<PointTrack> fixedPoints;

    [[nodiscard]] size_t numPointsFound() const
    {
        return points.size() + movingPoints.size() + doubtedPoints.size();
    }
};
}  // namespace pointplane
