// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/Odometry.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <algorithm>
#include <iostream>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Distance between the last estimated and the last true position, start aligned [m]. */
struct EndErrors
{
    double planes{0}, both{0};
    int untracked{0};
};

EndErrors run(const SimulationParams& params)
{
    const SimulatedSequence sequence("corner", params, 1);
    OdometryParams planesOnly;
    planesOnly.pipeline.usePoints = false;
    Odometry planes(planesOnly), both;
    OdometryResult lastPlanes, lastBoth;
    EndErrors out;
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        const RgbdFrame frame = sequence.frame(i);
        lastPlanes = planes.process(frame);
        lastBoth = both.process(frame);
        for (const OdometryResult& r : {lastPlanes, lastBoth})
        {
            out.untracked +=
                r.status == TrackingStatus::Predicted || r.status == TrackingStatus::Lost ? 1 : 0;
        }
    }
    const Eigen::Vector3d end = sequence.trueMotion(0, sequence.numFrames() - 1).translation();
    out.planes = (lastPlanes.pose.mean.translation() - end).norm();
    out.both = (lastBoth.pose.mean.translation() - end).norm();
    std::cout << "end error, planes alone " << 1e3 * out.planes << " mm, points and planes "
              << 1e3 * out.both << " mm\n";
    return out;
}
}  // namespace

/** The sequence of [P17, Fig. 5], whose planes alone ended 114 mm away. */
TEST(OdometryCorner, wholeSequenceEndsWhereItShould)
{
    const EndErrors errors = run({});
    EXPECT_LT(errors.planes, 0.114);
    EXPECT_LT(errors.both, 0.020);
    EXPECT_EQ(errors.untracked, 0);
}
}  // namespace pointplane
