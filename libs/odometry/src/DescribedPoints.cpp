// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/DescribedPoints.h>

#include <utility>

namespace pointplane
{
DescribedPoints describe(
    const RgbdFrame& frame, const PointDetector& detector, const PointLifter& lifter)
{
    const DetectedPoints detected = detector.detect(frame.gray);
    LiftedPoints lifted = lifter.liftAll(frame, detected.uv_px);
    DescribedPoints out;
    out.points = std::move(lifted.points);
    for (const int i : lifted.index)
    {
        out.descriptors.push_back(detected.descriptors.row(i));
    }
    return out;
}
}  // namespace pointplane
