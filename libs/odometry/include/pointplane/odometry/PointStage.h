// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/odometry/DescribedPoints.h>
#include <pointplane/points/PointDetector.h>
#include <pointplane/points/PointLifter.h>
#include <pointplane/points/PointMatcher.h>
#include <pointplane/points/PointTracker.h>

#include <string>
#include <vector>

namespace pointplane
{
/** What has to be made of an image before points can be found in it. */
struct PreparedPoints
{
    std::vector<cv::Mat> pyramid;  //!< tracking: of the image
    DescribedPoints described;     //!< matching
};

/** Finds points of a reference again in the current frame, by one of two methods: `track` searches
 * for the reference's corners in the current image, `match` compares descriptors of key points of
 * both images, as in [P17]. */
class PointStage
{
 public:
    struct TParams
    {
        std::string method{"track"};

        template <class V>
        void visit(V&& v)
        {
            v("method",
              method,
              "-",
              "track: corners near where they should be ([PointTracker]); "
              "match: key points by their descriptors ([PointDetector], [PointMatcher])");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
        [[nodiscard]] bool tracks() const;  //!< or matches
    };

    /** \throws std::invalid_argument naming the key */
    PointStage(
        const TParams& params,
        const PointTracker::TParams& tracker,
        const PointDetector::TParams& detector,
        const PointMatcher::TParams& matcher,
        const PointLifter::TParams& lifter,
        const DepthNoise& noise);

    /** Sets the noise of points that are lifted from now on. */
    void setNoise(const DepthNoise& noise);

    [[nodiscard]] PreparedPoints prepare(const RgbdFrame& frame) const;

    /** The points of a frame that later ones are compared with. \param prepared of the same frame
     */
    [[nodiscard]] PointReference makeReference(
        const RgbdFrame& frame, const PreparedPoints& prepared) const;

    /** Whether it finds a point in the image, if depth is of no concern. Takes time. */
    [[nodiscard]] bool findsPoint(const RgbdFrame& frame) const;

    /** Points of the reference found in the current frame.
     * \param prepared of that frame \param T_cur_ref predicted motion
     * \param radiusFactor widens the search (tracking only) */
    [[nodiscard]] std::vector<PointTrack> correspond(
        const PointReference& reference,
        const RgbdFrame& frame,
        const PreparedPoints& prepared,
        const Eigen::Isometry3d& T_cur_ref,
        double radiusFactor) const;

    /** How far from its predicted place a point is searched for, with a radiusFactor of 1 [px]. */
    [[nodiscard]] double searchRadius_px(const RgbdFrame& frame) const;

 private:
    bool tracks_;  //!< or matches
    PointTracker tracker_;
    PointDetector detector_;
    PointMatcher matcher_;
    PointLifter lifter_;
    double wallDepth_m_;  //!< any depth that counts as a reading, for findsPoint()
};
}  // namespace pointplane
