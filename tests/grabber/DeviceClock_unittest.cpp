// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/DeviceClock.h>

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace
{
using namespace pointplane;

constexpr double kPeriod = 1.0 / 30.0;
constexpr double kEpoch = 1.7e9;
constexpr double kTransfer = 0.020;  // [s] smallest delay from stamp to arrival

/** A camera whose clock runs `rate` times as fast as UTC; images arrive late by an exponential
 * delay on top of the transfer. */
class SimulatedArrivals
{
 public:
    SimulatedArrivals(double rate, double meanDelay, unsigned seed)
        : rate_(rate), delay_(1.0 / meanDelay), random_(seed)
    {
    }
    ClockReading next()
    {
        const double utc = kEpoch + kPeriod * k_++;
        return {100.0 + (utc - kEpoch) * rate_, utc + kTransfer + delay_(random_)};
    }
    [[nodiscard]] double trueUtc(double device) const { return kEpoch + (device - 100.0) / rate_; }

 private:
    double rate_;
    std::exponential_distribution<double> delay_;
    std::mt19937 random_;
    int k_{0};
};

TEST(DeviceTimeScale, recognisesWrongUnits)
{
    const auto readings = [](double scale) {
        return std::vector<ClockReading>{{5.0, kEpoch}, {5.0 + scale, kEpoch + 1.0}};
    };
    EXPECT_EQ(deviceTimeScale(readings(1.0)), 1.0);
    EXPECT_EQ(deviceTimeScale(readings(60.0)), 1.0 / 60.0);
    EXPECT_EQ(deviceTimeScale(readings(0.001)), 1000.0);
    EXPECT_EQ(deviceTimeScale(readings(1.4)), 1.0);  // a host that was held up
    EXPECT_FALSE(deviceTimeScale(readings(0.0)).has_value());
    EXPECT_FALSE(deviceTimeScale(readings(7.0)).has_value());
    EXPECT_FALSE(deviceTimeScale({{5.0, kEpoch}}).has_value());
}

TEST(DeviceClock, keepsTheSpacingOfTheDevice)
{
    SimulatedArrivals arrivals(1.0, 0.010, 1);
    DeviceClock clock;
    for (int k = 0; k < 30; ++k)
    {
        clock.observe(arrivals.next());
    }
    clock.lock();
    double lastDevice = 0.0, lastStamp = 0.0;
    for (int k = 0; k < 3000; ++k)
    {
        const auto reading = arrivals.next();
        clock.observe(reading);
        const double stamp = clock.utc(reading.device);
        if (k > 0)
        {
            // 2e-4 of a frame period is 7 us; host jitter is 10 ms.
            EXPECT_NEAR(stamp - lastStamp, reading.device - lastDevice, 2.1e-4 * kPeriod);
        }
        lastDevice = reading.device;
        lastStamp = stamp;
    }
}

TEST(DeviceClock, offsetIsTheSmallestDelay)
{
    SimulatedArrivals arrivals(1.0, 0.010, 2);
    DeviceClock clock;
    ClockReading reading;
    for (int k = 0; k < 600; ++k)
    {
        reading = arrivals.next();
        clock.observe(reading);
    }
    const double error = clock.utc(reading.device) - arrivals.trueUtc(reading.device);
    EXPECT_GE(error, kTransfer - 1e-6);
    EXPECT_LT(error, kTransfer + 0.001);
}

TEST(DeviceClock, followsTheDriftOfAQuartz)
{
    for (const double ppm : {-100.0, 100.0})
    {
        SimulatedArrivals arrivals(1.0 + 1e-6 * ppm, 0.002, 3);
        DeviceClock clock;
        for (int k = 0; k < 30; ++k)
        {
            clock.observe(arrivals.next());
        }
        clock.lock();
        ClockReading reading;
        for (int k = 0; k < 30 * 1800; ++k)  // half an hour: 180 ms of drift
        {
            reading = arrivals.next();
            clock.observe(reading);
        }
        const double error = clock.utc(reading.device) - arrivals.trueUtc(reading.device);
        EXPECT_NEAR(error, kTransfer, 0.005) << ppm << " ppm";
        EXPECT_NEAR(1e6 * clock.drift(), -ppm, 5.0);
    }
}

TEST(DeviceClock, startsAgainWhenTheCameraResets)
{
    DeviceClock clock;
    clock.observe({1000.0, kEpoch});
    clock.observe({1000.0 + kPeriod, kEpoch + kPeriod});
    clock.lock();
    clock.observe({0.5, kEpoch + 2 * kPeriod});
    EXPECT_EQ(clock.numJumps(), 1U);
    EXPECT_NEAR(clock.utc(0.5), kEpoch + 2 * kPeriod, 1e-6);
}

TEST(DeviceClock, aLongPauseOfTheCameraIsNoJump)
{
    DeviceClock clock;
    clock.observe({10.0, kEpoch});
    clock.lock();
    clock.observe({70.0, kEpoch + 60.0});
    EXPECT_EQ(clock.numJumps(), 0U);
}
}  // namespace
