// SPDX-License-Identifier: BSD-3-Clause
#include "RunSummary.h"

#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
std::string textOf(const RunSummary& summary)
{
    std::ostringstream out;
    summary.print(out, false);
    return out.str();
}
}  // namespace

TEST(RunSummary, intrinsicsThatDoNotFitAreTold)
{
    RunSummary summary;
    summary.label = "RGBD";
    summary.numFrames = summary.numTracked = 90;
    summary.hasMotion = true;
    EXPECT_THAT(textOf(summary), testing::Not(testing::HasSubstr("intrinsics")));
    summary.firstContradicted = 44;
    EXPECT_THAT(textOf(summary), testing::HasSubstr("after frame 44, the intrinsics"));
}
}  // namespace pointplane
