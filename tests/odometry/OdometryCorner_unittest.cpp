// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/Odometry.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <iostream>

#include "hell_frames.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** What became of an odometry on the whole sequence. */
struct Course
{
    Odometry odometry;
    OdometryResult last;
    double nees{0};  //!< of increments, per degree of freedom: mean
    int untracked{0};

    void process(const SimulatedSequence& sequence, int i, const RgbdFrame& frame)
    {
        last = odometry.process(frame);
        if (i > 0)
        {
            const Eigen::Isometry3d truth = sequence.trueMotion(i - 1, i);
            const double sigmas = test::normalisedError(truth, last.increment);
            nees += sigmas * sigmas / (sequence.numFrames() - 1);
            untracked += last.status == TrackingStatus::Tracked ? 0 : 1;
        }
    }

    /** Expects an end at most so far from the true one, start aligned [m]. */
    void expectEnd(const SimulatedSequence& sequence, const char* features, double most) const
    {
        const Eigen::Isometry3d end = sequence.trueMotion(0, sequence.numFrames() - 1);
        const double error = (last.pose.mean.translation() - end.translation()).norm();
        const double sigmas = test::normalisedError(end, last.pose);
        std::cout << features << ": end error " << 1e3 * error << " mm, " << sigmas
                  << " standard deviations; NEES of increments " << nees << "\n";
        EXPECT_LT(error, most) << features;
        EXPECT_LT(sigmas, 3) << features;
        EXPECT_LT(nees, 2) << features;
        EXPECT_EQ(untracked, 0) << features;
    }
};
}  // namespace

/** The sequence of [P17, Fig. 5], whose planes alone ended 114 mm away, in a quarter of its pixels.
 */
TEST(OdometryCorner, wholeSequenceEndsWhereItShould)
{
    SimulationParams small;
    small.width = 320;
    small.height = 240;
    const SimulatedSequence sequence("corner", small, 1);
    OdometryParams planesOnly;
    planesOnly.pipeline.usePoints = false;
    Course planes{Odometry(planesOnly), {}}, both{Odometry(), {}};
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        const RgbdFrame frame = sequence.frame(i);
        planes.process(sequence, i, frame);
        both.process(sequence, i, frame);
    }
    planes.expectEnd(sequence, "planes alone", 0.0045);
    both.expectEnd(sequence, "points and planes", 0.003);
    EXPECT_GT(both.nees, 0.3);
}
}  // namespace pointplane
