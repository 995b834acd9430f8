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

/** Body velocities that undo the rolling shutter. */
struct FrameVelocities
{
    Vector6d previous{Vector6d::Zero()};
    Vector6d current{Vector6d::Zero()};
};

/** Turns associations into pairs in the base frame (the camera at the previous frame), freed from
 * the rolling shutter. */
class PairBuilder
{
 public:
    PairBuilder(const Reference& previous, const Reference& current, int imageHeight)
        : previous_(previous), current_(current), imageHeight_(imageHeight)
    {
    }

    void build(
        const std::vector<Association>& associations,
        const FrameVelocities& velocities,
        const ShutterCalibrator& shutter,
        std::vector<PointPair>& points,
        std::vector<PlanePair>& planes) const;

 private:
    const Reference& previous_;
    const Reference& current_;
    int imageHeight_;
};
}  // namespace pointplane
