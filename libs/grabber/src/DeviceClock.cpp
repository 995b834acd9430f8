// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/DeviceClock.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
std::optional<double> deviceTimeScale(const std::vector<ClockReading>& readings)
{
    // The units are far apart; the host's times over a short while are not that good.
    constexpr double kTolerance = 2.0;
    if (readings.size() < 2)
    {
        return std::nullopt;
    }
    const double device = readings.back().device - readings.front().device;
    const double host = readings.back().arrival - readings.front().arrival;
    if (device <= 0.0 || host <= 0.0)
    {
        return std::nullopt;
    }
    for (const double scale : {1.0, 1.0 / 60.0, 1000.0})
    {
        const double ratio = device * scale / host;
        if (ratio < kTolerance && ratio > 1.0 / kTolerance)
        {
            return scale;
        }
    }
    return std::nullopt;
}

DeviceClock::DeviceClock() : DeviceClock(TParams{}) {}

DeviceClock::DeviceClock(const TParams& params) : params_(params) {}

void DeviceClock::restart(const ClockReading& reading)
{
    offset_ = currentMin_ = previousMin_ = reading.arrival - reading.device;
    offsetAtStart_ = offset_;
    bucketStart_ = deviceAtStart_ = reading.device;
    last_ = reading;
    started_ = true;
}

void DeviceClock::observe(const ClockReading& reading)
{
    if (!started_)
    {
        restart(reading);
        return;
    }
    const double deviceStep = reading.device - last_.device;
    const double hostStep = reading.arrival - last_.arrival;
    if (deviceStep < 0.0 || std::abs(deviceStep - hostStep) > params_.maxJump)
    {
        ++numJumps_;
        restart(reading);
        return;
    }
    updateSmallestDelay(reading);
    const double target = std::min(currentMin_, previousMin_);
    const double maxStep = params_.maxSlew * deviceStep;
    if (locked_)
    {
        offset_ += std::clamp(target - offset_, -maxStep, maxStep);
    }
    else
    {
        offset_ = offsetAtStart_ = target;
        deviceAtStart_ = reading.device;
    }
    last_ = reading;
}

void DeviceClock::updateSmallestDelay(const ClockReading& reading)
{
    // Two half windows: the minimum over the last half to whole window, without a list.
    const double delay = reading.arrival - reading.device;
    if (reading.device - bucketStart_ > params_.window / 2.0)
    {
        previousMin_ = currentMin_;
        currentMin_ = delay;
        bucketStart_ = reading.device;
    }
    currentMin_ = std::min(currentMin_, delay);
}

double DeviceClock::drift() const
{
    const double elapsed = last_.device - deviceAtStart_;
    return elapsed > 0.0 ? (offset_ - offsetAtStart_) / elapsed : 0.0;
}
}  // namespace pointplane
