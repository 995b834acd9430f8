// SPDX-License-Identifier: BSD-3-Clause
#include "conditions.h"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;
using testing::ElementsAre;

namespace
{
/** The condition of that name, or one without runs. */
Condition find(const std::vector<Condition>& all, const std::string& name)
{
    const auto it =
        std::find_if(all.begin(), all.end(), [&](const Condition& c) { return c.name == name; });
    return it == all.end() ? Condition() : *it;
}

std::vector<std::size_t> framesOf(const EnvelopeRun& run)
{
    std::vector<std::size_t> out;
    for (const FrameUse& use : run)
    {
        out.push_back(use.at);
    }
    return out;
}
}  // namespace

TEST(EnvelopeConditions, EveryNthFrameFromAllStartingFrames)
{
    const auto all = envelopeConditions(35, 30, {});
    const Condition full = find(all, "30 Hz");
    ASSERT_EQ(full.runs.size(), 1U);
    EXPECT_EQ(full.runs[0].size(), 35U);

    const Condition slow = find(all, "3 Hz");
    ASSERT_EQ(slow.runs.size(), 10U);
    EXPECT_THAT(framesOf(slow.runs[0]), ElementsAre(0U, 10U, 20U, 30U));
    EXPECT_THAT(framesOf(slow.runs[9]), ElementsAre(9U, 19U, 29U));
    std::set<std::size_t> seen;
    for (const EnvelopeRun& run : slow.runs)
    {
        for (const FrameUse& use : run)
        {
            EXPECT_EQ(use.at, use.shown);
            seen.insert(use.at);
        }
    }
    EXPECT_EQ(seen.size(), 35U);
    EXPECT_TRUE(find(all, "1 Hz").runs.empty());  // two frames are no sequence
}

TEST(EnvelopeConditions, RatesThatACameraDoesNotReachAreLeftOut)
{
    const auto all = envelopeConditions(150, 15, {});
    EXPECT_TRUE(find(all, "30 Hz").runs.empty());
    EXPECT_EQ(find(all, "15 Hz").runs.size(), 1U);
    EXPECT_EQ(find(all, "3 Hz").runs.size(), 5U);
}

TEST(EnvelopeConditions, AGapIsLeftOutInTenPlaces)
{
    const Condition gap = find(envelopeConditions(200, 30, {}), "gap 15");
    ASSERT_EQ(gap.runs.size(), 10U);
    std::set<std::size_t> places;
    for (const EnvelopeRun& run : gap.runs)
    {
        const std::vector<std::size_t> frames = framesOf(run);
        std::size_t jumps = 0;
        for (std::size_t k = 1; k < frames.size(); ++k)
        {
            if (frames[k] != frames[k - 1] + 1)
            {
                EXPECT_EQ(frames[k], frames[k - 1] + 16);
                EXPECT_GE(k, 10U);
                EXPECT_GE(frames.size() - k, 5U);
                places.insert(frames[k]);
                ++jumps;
            }
        }
        EXPECT_EQ(jumps, 1U);
        EXPECT_LT(frames.back(), 200U);
    }
    EXPECT_EQ(places.size(), 10U);
    EXPECT_TRUE(find(envelopeConditions(60, 30, {}), "gap 50").runs.empty());
}

TEST(EnvelopeConditions, ImagesAreMissingForAsLong)
{
    const auto all = envelopeConditions(100, 30, {});
    for (const char* name : {"no depth 10", "no colour 10", "no images 10", "foreign 1"})
    {
        const Condition condition = find(all, name);
        ASSERT_EQ(condition.runs.size(), 10U) << name;
        for (const EnvelopeRun& run : condition.runs)
        {
            const auto changed = std::count_if(
                run.begin(), run.end(), [](const FrameUse& use) { return bool(use.change); });
            EXPECT_EQ(changed, condition.name == "foreign 1" ? 1 : 10) << name;
            EXPECT_EQ(run.back().at - run.front().at + 1, run.size()) << name;
        }
    }
}

TEST(EnvelopeConditions, AFrozenCameraShowsWhatItSawLast)
{
    const Condition frozen = find(envelopeConditions(100, 30, {}), "frozen 3");
    ASSERT_EQ(frozen.runs.size(), 10U);
    for (const EnvelopeRun& run : frozen.runs)
    {
        std::size_t old = 0;
        for (std::size_t k = 1; k < run.size(); ++k)
        {
            EXPECT_EQ(run[k].at, run[k - 1].at + 1);
            if (run[k].shown != run[k].at)
            {
                EXPECT_EQ(run[k].shown, run[k - 1].shown);
                ++old;
            }
        }
        EXPECT_EQ(old, 3U);
    }
}
