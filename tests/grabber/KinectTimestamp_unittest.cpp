// SPDX-License-Identifier: BSD-3-Clause
#include "KinectTimestamp.h"

#include <gtest/gtest.h>

namespace
{
using namespace pointplane;

TEST(KinectTimestamp, countsOnWhenThe32BitsOverflow)
{
    KinectTimestamp timestamp;
    const double before = timestamp.seconds(4294967295U);  // 2^32 - 1
    const double after = timestamp.seconds(1999999U);
    EXPECT_NEAR(after - before, 2e6 / 60e6, 1e-12);
}

TEST(KinectTimestamp, theOtherStreamMayBeSlightlyEarlier)
{
    KinectTimestamp timestamp;
    const double first = timestamp.seconds(600000U);
    EXPECT_NEAR(timestamp.seconds(0U) - first, -0.01, 1e-12);
    EXPECT_NEAR(timestamp.seconds(1200000U) - first, 0.01, 1e-12);
}
}  // namespace
