// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/FramePairer.h>

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace
{
using namespace pointplane;

constexpr double kFramePeriod = 1.0 / 30.0;

CameraImage image(StreamKind stream, std::int64_t index, double time)
{
    CameraImage result;
    result.stream = stream;
    result.index = index;
    result.deviceTime = time;
    return result;
}

CameraImage depth(std::int64_t index, double time) { return image(StreamKind::Depth, index, time); }

CameraImage colour(std::int64_t index, double time)
{
    return image(StreamKind::Colour, index, time);
}

TEST(FramePairer, pairsInEitherOrderOfArrival)
{
    FramePairer pairer(kFramePeriod / 2, kFramePeriod);
    EXPECT_TRUE(pairer.add(depth(1, 0.000)).empty());
    const auto first = pairer.add(colour(1, 0.003));
    EXPECT_TRUE(pairer.add(colour(2, 0.036)).empty());
    const auto second = pairer.add(depth(2, 0.033));
    ASSERT_EQ(first.size(), 1U);
    ASSERT_EQ(second.size(), 1U);
    EXPECT_EQ(first[0].depth.index, 1);
    EXPECT_EQ(first[0].colour.index, 1);
    EXPECT_EQ(second[0].depth.index, 2);
    EXPECT_EQ(pairer.counts().pairs, 2U);
    EXPECT_NEAR(pairer.counts().meanSkew, 0.003, 1e-12);
}

TEST(FramePairer, imagesTooFarApartAreCountedNotJoined)
{
    FramePairer pairer(0.005, kFramePeriod);
    EXPECT_TRUE(pairer.add(depth(1, 0.000)).empty());
    EXPECT_TRUE(pairer.add(colour(1, 0.010)).empty());  // depth 1 can have no partner any more
    EXPECT_EQ(pairer.counts().unpairedDepth, 1U);
    const auto pairs = pairer.add(depth(2, 0.012));
    ASSERT_EQ(pairs.size(), 1U);
    EXPECT_EQ(pairs[0].depth.index, 2);
    EXPECT_EQ(pairer.counts().unpairedColour, 0U);
}

TEST(FramePairer, aLostImageLeavesItsPartnerAloneAndIsCounted)
{
    FramePairer pairer(kFramePeriod / 2, kFramePeriod);
    std::size_t pairs = 0;
    for (int k = 0; k < 10; ++k)
    {
        pairs += pairer.add(depth(k, k * kFramePeriod)).size();
        if (k != 4 && k != 5)
        {
            pairs += pairer.add(colour(k, k * kFramePeriod + 0.002)).size();
        }
    }
    EXPECT_EQ(pairs, 8U);
    EXPECT_EQ(pairer.counts().droppedColour, 2U);
    EXPECT_EQ(pairer.counts().droppedDepth, 0U);
    EXPECT_EQ(pairer.counts().unpairedDepth, 2U);
}

TEST(FramePairer, anIndexThatStartsAgainIsNoLoss)
{
    FramePairer pairer(kFramePeriod / 2, kFramePeriod);
    (void)pairer.add(depth(100, 0.0));
    (void)pairer.add(depth(1, kFramePeriod));
    EXPECT_EQ(pairer.counts().droppedDepth, 0U);
}

/** Where the driver counts what it delivers. */
TEST(FramePairer, gapsInTheStampsAreLosses)
{
    FramePairer pairer(kFramePeriod / 2, kFramePeriod);
    (void)pairer.add(depth(1, 1.0));
    (void)pairer.add(depth(2, 1.034));
    (void)pairer.add(depth(3, 1.134));  // 3 periods later
    EXPECT_EQ(pairer.counts().droppedDepth, 2U);
    (void)pairer.add(depth(4, 1.1341));
    (void)pairer.add(depth(7, 1.234));  // both tell of the same
    EXPECT_EQ(pairer.counts().droppedDepth, 4U);
    (void)pairer.add(depth(8, 1001.0));  // the clock was set
    EXPECT_EQ(pairer.counts().droppedDepth, 4U);
}

TEST(FramePairer, timesOfArrivalTellOfNoLoss)
{
    FramePairer pairer(kFramePeriod / 2, kFramePeriod);
    for (int k = 1; k < 5; ++k)
    {
        auto late = depth(k, k * 3 * kFramePeriod);
        late.hasClock = false;
        (void)pairer.add(late);
    }
    EXPECT_EQ(pairer.counts().droppedDepth, 0U);
}

TEST(FramePairer, aStreamAloneIsLetGo)
{
    FramePairer pairer(kFramePeriod / 2, kFramePeriod);
    for (int k = 0; k < 100; ++k)
    {
        EXPECT_TRUE(pairer.add(depth(k, k * kFramePeriod)).empty());
    }
    EXPECT_GT(pairer.counts().unpairedDepth, 80U);
    pairer.finish();
    EXPECT_EQ(pairer.counts().unpairedDepth, 100U);
}

TEST(FramePairer, depthOnlyNeedsNoColour)
{
    FramePairer pairer(kFramePeriod / 2, kFramePeriod, true);
    EXPECT_EQ(pairer.add(depth(1, 0.0)).size(), 1U);
    EXPECT_TRUE(pairer.add(depth(2, kFramePeriod)).front().colour.pixels.empty());
}

TEST(FramePairer, rejectsASkewOfZero)
{
    EXPECT_THROW(FramePairer(0.0, kFramePeriod), std::invalid_argument);
    EXPECT_THROW(FramePairer(kFramePeriod, 0.0), std::invalid_argument);
}

/** Every image is paired once or counted, pairs are in order and within the limit, whatever is lost
 * and however the streams are shifted and jittered. */
TEST(FramePairer, everyImageIsAccountedFor)
{
    for (unsigned seed = 0; seed < 50; ++seed)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const double shift = (uniform(random) - 0.5) * kFramePeriod;
        FramePairer pairer(kFramePeriod / 2, kFramePeriod);
        std::uint64_t numDepth = 0, numColour = 0;
        double lastTime = -1.0;
        const auto check = [&](const std::vector<ImagePair>& pairs)
        {
            for (const auto& pair : pairs)
            {
                EXPECT_LE(
                    std::abs(pair.depth.deviceTime - pair.colour.deviceTime),
                    kFramePeriod / 2 + 1e-12);
                EXPECT_GT(pair.depth.deviceTime, lastTime);
                lastTime = pair.depth.deviceTime;
            }
        };
        for (int k = 0; k < 200; ++k)
        {
            const double jitter = 0.001 * uniform(random);
            if (uniform(random) > 0.1)
            {
                check(pairer.add(depth(k, k * kFramePeriod + jitter)));
                ++numDepth;
            }
            if (uniform(random) > 0.1)
            {
                check(pairer.add(colour(k, k * kFramePeriod + shift + jitter)));
                ++numColour;
            }
        }
        pairer.finish();
        const auto& counts = pairer.counts();
        EXPECT_EQ(counts.pairs + counts.unpairedDepth, numDepth);
        EXPECT_EQ(counts.pairs + counts.unpairedColour, numColour);
        EXPECT_GT(counts.pairs, 120U) << "seed " << seed << " shift " << shift;
    }
}
}  // namespace
