// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/Odometry.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "OverlaySink.h"
#include "TempDir.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** The second frame of a room corner in 640x480 pixels, with all that its picture shows. */
[[nodiscard]] OutputItem typicalItem()
{
    const SimulatedSequence room("corner", {}, 1);
    OutputItem out;
    Odometry odometry(OdometryParams{});
    FrameRecord record;
    for (const int i : {0, 1})
    {
        out.source.converted.emplace();
        out.source.converted->frame = room.frame(i);
        record.motion.cameraPose = odometry.process(out.source.converted->frame).pose;
    }
    record.features = odometry.features();
    out.frame = record;
    return out;
}
}  // namespace

/** The least of several: other programs may be running. */
TEST(OverlayCost, aPictureTakesLessThanTenMilliseconds)
{
#ifdef POINTPLANE_IS_OPTIMISED
    constexpr double kMostMs = 10;
#else
    constexpr double kMostMs = 400;  // not built for speed
#endif
    constexpr int kRuns = 30;
    const test::TempDir dir;
    OverlaySink sink(dir / "pictures", 1);
    OutputItem item = typicalItem();
    const FrameFeatures& features = item.frame->features;
    EXPECT_GE(features.points.size(), 150U);
    EXPECT_GE(features.planes.planes.size(), 2U);
    double least = 1e9;
    for (int i = 0; i < kRuns; ++i)
    {
        item.source.frameIndex = static_cast<std::size_t>(i);
        item.source.converted->frame.stamp += 1 / 30.0;
        const auto start = std::chrono::steady_clock::now();
        sink.add(item);
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - start;
        least = std::min(least, took.count());
    }
    std::cout << "an overlay takes " << least << " ms\n";
    EXPECT_LT(least, kMostMs) << "ms for drawing and writing a JPEG of 640x480";
}
}  // namespace pointplane
