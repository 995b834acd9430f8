// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/Odometry.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <atomic>
#include <cstdlib>
#include <iostream>
#include <new>

#include <gtest/gtest.h>

namespace
{
std::atomic<long> allocations{0};

void* counted(std::size_t size)
{
    ++allocations;
    return std::malloc(size == 0 ? 1 : size);
}

void* countedOrThrow(std::size_t size)
{
    if (void* p = counted(size))
    {
        return p;
    }
    throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return countedOrThrow(size); }
void* operator new[](std::size_t size) { return countedOrThrow(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return counted(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return counted(size); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }

namespace pointplane
{
/** Of C++; images come from OpenCV's own pool of memory. */
TEST(Allocations, areFewInTheSteadyState)
{
    constexpr int kWarm = 5, kFrames = 10;
    SimulationParams simulation;
    simulation.duration = 1;
    const SimulatedSequence sequence("desk", simulation, 1);
    OdometryParams params;
    params.pipeline.numThreads = 1;
    Odometry odometry(params);
    long counted = 0;
    for (int k = 0; k < kWarm + kFrames; ++k)
    {
        const RgbdFrame frame = sequence.frame(k);
        const long before = allocations;
        const OdometryResult result = odometry.process(frame);
        counted += k < kWarm ? 0 : allocations - before;
        ASSERT_NE(result.status, TrackingStatus::Lost);
    }
    std::cout << counted / kFrames << " allocations per frame\n";
    EXPECT_LT(counted / kFrames, 1000);
}
}  // namespace pointplane
