// SPDX-License-Identifier: BSD-3-Clause
#include "accuracy_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;
using testing::HasSubstr;

/** Another of our methods must not stand in for it without a word. */
TEST(AccuracyTables, AFailureOfOurFirstMethodIsSeen)
{
    MethodScore own, next, peer;
    own.method = "config.ini";
    own.failure = "no frame";
    next.method = "config-fast.ini";
    peer.method = "peer";
    peer.isPeer = true;
    EXPECT_THAT(
        markdownSummary({{"desk", {own, next, peer}}}),
        testing::AllOf(
            HasSubstr("config.ini [mm / deg]"), HasSubstr("| desk | no | **failed** |")));
    EXPECT_THROW(requireNoFailures({{"desk", {next, own}}}), IncompleteError);
    peer.failure = own.failure;
    EXPECT_NO_THROW(requireNoFailures({{"desk", {next, peer}}}));
}
