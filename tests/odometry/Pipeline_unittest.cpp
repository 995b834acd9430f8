// SPDX-License-Identifier: BSD-3-Clause
/** What the switches of the pipeline switch. */
#include "hell_frames.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Nothing is known of the motion over a second and a half: whole images tell it, if they are
 * searched. */
TEST(Pipeline, searchImages)
{
    for (const bool searches : {true, false})
    {
        OdometryParams params;
        params.pipeline.searchImages = searches;
        test::CheckedOdometry odometry(params);
        test::CachedSequence& desk = test::CachedSequence::desk();
        (void)odometry.process(desk.frame(0));
        RgbdFrame later = desk.frame(45);
        later.stamp += 20;
        const OdometryResult result = odometry.process(later);
        EXPECT_EQ(result.status, searches ? TrackingStatus::Tracked : TrackingStatus::Predicted);
    }
}

/** Depth that contradicts what the features say: without the comparison, they are believed. */
TEST(Pipeline, leastAgreement)
{
    struct Try
    {
        double least, scale;
    };
    for (const auto& [least, scale] : {Try{0.5, 1.3}, Try{0.5, 1.4}, Try{0.0, 1.4}})
    {
        OdometryParams params;
        params.pipeline.leastAgreement = least;
        test::CheckedOdometry odometry(params);
        test::CachedSequence& desk = test::CachedSequence::desk();
        for (int i = 0; i < 5; ++i)
        {
            (void)odometry.process(desk.frame(i));
        }
        RgbdFrame frame = desk.frame(5);
        frame.depth *= scale;  // as from a camera whose scale has changed
        const OdometryResult result = odometry.process(frame);
        EXPECT_EQ(result.status, least > 0 ? TrackingStatus::Predicted : TrackingStatus::Tracked)
            << result.reason;
    }
}
}  // namespace
}  // namespace pointplane
