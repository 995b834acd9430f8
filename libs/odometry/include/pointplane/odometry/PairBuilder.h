// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/Reference.h>
#include <pointplane/planes/PlaneMatcher.h>
#include <pointplane/pose/pairs.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <vector>

namespace pointplane
{
class ShutterCalibrator;

/** What one reference and the current frame have in common. */
struct Association
{
    const Reference* reference{nullptr};
    std::vector<PlaneMatch> planes;
    std::vector<PointTrack> points;
};

/** Turns associations into pairs in the base frame (the camera at the previous frame). References
 * are freed from the rolling shutter; how the current frame depends on its velocity is told. */
class PairBuilder
{
 public:
    PairBuilder(const Reference& previous, const Reference& current, const PinholeCamera& camera)
        : previous_(previous), current_(current), camera_(camera)
    {
    }

    void build(
        const std::vector<Association>& associations,
        const ShutterCalibrator& shutter,
        std::vector<PointPair>& points,
        std::vector<PlanePair>& planes) const;

    /** Orientation of the base frame. */
    [[nodiscard]] Eigen::Matrix3d R_world_base() const { return previous_.T_world_cam.linear(); }

 private:
    const Reference& previous_;
    const Reference& current_;
    const PinholeCamera& camera_;
};
}  // namespace pointplane
