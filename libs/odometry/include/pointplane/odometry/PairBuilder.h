// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/Features.h>
#include <pointplane/odometry/Reference.h>
#include <pointplane/pose/pairs.h>

#include <vector>

namespace pointplane
{
class ShutterCalibrator;

/** Turns associations into pairs in the frame of the camera at the previous measured frame.
 * References are freed from the rolling shutter; how the current frame depends on its velocity is
 * told. */
class PairBuilder
{
 public:
    /** \param previous, current must live as long as this */
    PairBuilder(const Reference& previous, const Features& current)
        : previous_(previous), current_(current)
    {
    }

    void build(
        const std::vector<Association>& associations,
        const ShutterCalibrator& shutter,
        std::vector<PointPair>& points,
        std::vector<PlanePair>& planes) const;

    /** Fills in how the pairs err with the shutter, now that the current frame's velocity is known.
     * \param points, planes of the same associations */
    void addShutterErrors(
        const std::vector<Association>& associations,
        const ShutterCalibrator& shutter,
        const Vector6d& velocity,
        std::vector<PointPair>& points,
        std::vector<PlanePair>& planes) const;

    /** Orientation of the previous frame. */
    [[nodiscard]] Eigen::Matrix3d R_world_prev() const { return previous_.T_world_cam.linear(); }

 private:
    const Reference& previous_;
    const Features& current_;
};
}  // namespace pointplane
