// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/points/PointFeature.h>

#include <opencv2/core/mat.hpp>

#include <initializer_list>
#include <memory>
#include <vector>

namespace pointplane
{
struct ReferencePatches;

/** A point found again. */
struct PointTrack
{
    int ref{0};        //!< index into PointReference::points
    PointFeature cur;  //!< where it is in the current frame
};

/** The points of a reference frame, ready to be found again. All lists have one entry per point. */
struct PointReference
{
    std::vector<PointFeature> points;
    std::shared_ptr<const ReferencePatches> patches;  //!< tracking: what each looks like
    cv::Mat descriptors;                              //!< matching: a row a point
    std::vector<Eigen::Matrix2d> cov_px;  //!< tracking: noise of where each is found [px^2]
    std::vector<int> directions;          //!< in which each is measured: 2, or 1 of an edge
    /** Tracking: how far beside its place each is found in a brighter image, per relative change of
     * the brightness [px]. */
    std::vector<Eigen::Vector2d> ofBrightness_px;
    std::vector<int> misses;  //!< tracking: frames in a row without each point

    /** Counts misses: which points were found again in a frame. */
    void note(std::initializer_list<const std::vector<PointTrack>*> found);

    /** Whether to search for a point now. One that has been missing for some frames is searched for
     * only now and then, in turns with others, because a search in vain takes longest. */
    [[nodiscard]] bool isDue(size_t point) const;
};
}  // namespace pointplane
