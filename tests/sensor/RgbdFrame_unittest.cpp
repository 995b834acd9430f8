// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/RgbdFrame.h>

#include <limits>

#include <gtest/gtest.h>

namespace pointplane
{
TEST(RgbdFrame, hasDepthInAHundredthOfItsPixels)
{
    RgbdFrame frame;
    EXPECT_FALSE(hasDepth(frame));
    for (const float none : {0.0F, std::numeric_limits<float>::quiet_NaN()})
    {
        frame.depth = cv::Mat(100, 100, CV_32FC1, cv::Scalar(none));
        EXPECT_FALSE(hasDepth(frame));
        frame.depth.row(50).colRange(0, 99).setTo(1);
        EXPECT_FALSE(hasDepth(frame));
        frame.depth.row(99).col(99).setTo(1);
        EXPECT_TRUE(hasDepth(frame));
    }
}
}  // namespace pointplane
