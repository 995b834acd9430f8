// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/points/PointDetector.h>
#include <pointplane/points/PointLifter.h>
#include <pointplane/points/PointMatcher.h>
#include <pointplane/points/PointTracker.h>

#include <string>
#include <vector>

namespace pointplane
{
/** Points of a frame and their correspondences, by one of two methods behind one interface: `track`
 * (corners of the reference are searched for in the current image) or `match` (key points of both
 * images are matched by descriptor, as in [P17]). */
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
              "track (corners searched from the predicted position) or match (detector and "
              "descriptor)");
        }
        void check() const;
    };

    PointStage(
        const TParams& params,
        const PointTracker::TParams& tracker,
        const PointDetector::TParams& detector,
        const PointMatcher::TParams& matcher,
        const PointLifter::TParams& lifter,
        const DepthNoise& noise);

    /** Prepares the current frame: image pyramid, or key points with descriptors. */
    void prepare(const RgbdFrame& frame);

    /** Makes a reference of the frame that was prepared last. */
    [[nodiscard]] PointReference makeReference(const RgbdFrame& frame) const;

    /** Points of the reference found in the frame that was prepared last.
     * \param T_cur_ref predicted motion \param radiusFactor widens the search (tracking only) */
    [[nodiscard]] std::vector<PointTrack> correspond(
        const PointReference& reference,
        const RgbdFrame& frame,
        const Eigen::Isometry3d& T_cur_ref,
        double radiusFactor) const;

 private:
    [[nodiscard]] bool tracks() const { return params_.method == "track"; }

    TParams params_;
    PointTracker tracker_;
    PointDetector detector_;
    PointMatcher matcher_;
    PointLifter lifter_;
    std::vector<cv::Mat> pyramid_;  //!< of the prepared frame
    PointReference described_;      //!< key points of the prepared frame
};
}  // namespace pointplane
