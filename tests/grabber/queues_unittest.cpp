// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/BoundedQueue.h>
#include <pointplane/grabber/LatestPair.h>
#include <pointplane/grabber/ReorderBuffer.h>

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace
{
using namespace pointplane;

TEST(BoundedQueue, refusesWhenFullAndKeepsTheOrder)
{
    BoundedQueue<int> queue(2);
    EXPECT_TRUE(queue.tryPush(1));
    EXPECT_TRUE(queue.tryPush(2));
    EXPECT_FALSE(queue.tryPush(3));
    EXPECT_EQ(queue.pop(), 1);
    EXPECT_TRUE(queue.tryPush(4));
    queue.close();
    EXPECT_FALSE(queue.tryPush(5));
    EXPECT_EQ(queue.pop(), 2);
    EXPECT_EQ(queue.pop(), 4);
    EXPECT_FALSE(queue.pop().has_value());
}

TEST(BoundedQueue, pushWaitsForRoom)
{
    BoundedQueue<int> queue(1);
    std::thread producer(
        [&]
        {
            for (int i = 0; i < 100; ++i)
            {
                EXPECT_TRUE(queue.push(i));
            }
            queue.close();
        });
    int expected = 0;
    while (const auto value = queue.pop())
    {
        EXPECT_EQ(*value, expected++);
    }
    EXPECT_EQ(expected, 100);
    producer.join();
}

TEST(ReorderBuffer, restoresTheOrderOfParallelWorkers)
{
    constexpr std::uint64_t kCount = 200;
    ReorderBuffer<std::uint64_t> buffer(4);
    std::vector<std::thread> workers;
    for (std::uint64_t first : {0U, 1U, 2U})
    {
        workers.emplace_back(
            [&buffer, first]
            {
                for (std::uint64_t number = first; number < kCount; number += 3)
                {
                    buffer.put(number, number);
                }
            });
    }
    for (std::uint64_t expected = 0; expected < kCount; ++expected)
    {
        EXPECT_EQ(buffer.takeFor(std::chrono::seconds(10)), expected);
    }
    for (auto& worker : workers)
    {
        worker.join();
    }
    buffer.close();
    EXPECT_TRUE(buffer.isFinished());
}

TEST(ReorderBuffer, endsWhenANumberNeverComes)
{
    ReorderBuffer<int> buffer(4);
    buffer.put(1, 1);
    buffer.close();
    EXPECT_FALSE(buffer.takeFor(std::chrono::milliseconds(1)).has_value());
    EXPECT_TRUE(buffer.isFinished());
}

TEST(LatestPair, theNewestReplacesTheOthers)
{
    LatestPair latest;
    for (int i = 1; i <= 3; ++i)
    {
        ImagePair pair;
        pair.stamp = i;
        latest.put(pair);
    }
    EXPECT_EQ(latest.numReplaced(), 2U);
    EXPECT_EQ(latest.take()->stamp, 3.0);
    latest.close();
    EXPECT_FALSE(latest.take().has_value());
}

TEST(LatestPair, aSourceThatCanWaitLosesNothing)
{
    constexpr int kCount = 100;
    LatestPair latest;
    std::thread source(
        [&]
        {
            for (int i = 1; i <= kCount; ++i)
            {
                ImagePair pair;
                pair.stamp = i;
                latest.putWhenTaken(pair);
            }
            latest.close();
        });
    double expected = 1;
    while (const auto pair = latest.take())
    {
        EXPECT_EQ(pair->stamp, expected++);
    }
    source.join();
    EXPECT_EQ(expected, kCount + 1);
    EXPECT_EQ(latest.numReplaced(), 0U);
}
}  // namespace
