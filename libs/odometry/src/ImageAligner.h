// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/DescribedPoints.h>
#include <pointplane/points/PointDetector.h>
#include <pointplane/points/PointLifter.h>
#include <pointplane/points/PointMatcher.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <optional>
#include <vector>

namespace pointplane
{
/** Points of one frame, and which points of another they are by their descriptors. Some are wrong.
 */
struct MatchedPoints
{
    std::vector<Eigen::Vector3d> ref, cur;  //!< each in its own camera's frame [m]
};

/** Finds the motion between two frames without a prediction. Key points are matched by descriptor
 * over the whole image; three matches at a time give a motion, which all of them judge (Fischler
 * and Bolles 1981; Horn 1987). The same frames give the same motion. */
class ImageAligner
{
 public:
    ImageAligner(const PointLifter::TParams& lifter, const DepthNoise& noise);

    /** Sets the noise by which motions are judged from now on. */
    void setNoise(const DepthNoise& noise) { noise_ = noise; }

    /** Key points that can be found again without knowing where they are. */
    [[nodiscard]] DescribedPoints describe(const RgbdFrame& frame) const
    {
        return pointplane::describe(frame, detector_, lifter_);
    }

    /** By descriptor, over the whole image. */
    [[nodiscard]] MatchedPoints match(
        const DescribedPoints& reference, const DescribedPoints& current) const;

    /** \param camera of both frames
     * \return T_cur_ref; nothing if too few matches agree about a motion */
    [[nodiscard]] std::optional<Eigen::Isometry3d> align(
        const MatchedPoints& matches, const PinholeCamera& camera) const;

 private:
    PointDetector detector_;
    PointMatcher matcher_;
    PointLifter lifter_;
    DepthNoise noise_;
};
}  // namespace pointplane
