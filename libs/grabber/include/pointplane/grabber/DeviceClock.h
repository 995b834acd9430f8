// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace pointplane
{
/** Arrival of one image on two clocks. */
struct ClockReading
{
    double device{0};   //!< [s] the camera's time stamp
    double arrival{0};  //!< [s] UTC on the host
};

/** Unit of a camera's time stamps [s]: 1 if they are right, 1/60 if a driver hands out a 60 MHz
 * counter as microseconds, 1000 for milliseconds. Nothing if they follow no clock (they are
 * constant, or none of these within a factor of two): then only arrival times are left. \param
 * readings at least a few tenths of a second of one stream, in order of arrival */
[[nodiscard]] std::optional<double> deviceTimeScale(const std::vector<ClockReading>& readings);

/** Maps a camera's clock to UTC and keeps the camera's spacing.
 *
 * An image arrives some delay after its time stamp. The delay varies, but is never less than the
 * time of transfer. So the offset between the clocks is the smallest (arrival - device) seen
 * lately. Before lock() the offset follows it freely. Afterwards it moves slowly, to follow the
 * drift of the quartz: two stamps differ by the device's interval times 1 +- maxSlew, so jitter of
 * the host never reaches them. The constant part of the delay cannot be observed and remains. */
class DeviceClock
{
 public:
    struct TParams
    {
        double maxSlew{2e-4};  //!< a cheap quartz is off by up to 100 ppm; twice that can catch up
        double window{20.0};   //!< [s] over which the smallest delay counts
        double maxJump{1.0};   //!< [s] the clocks may disagree about an interval before a restart
    };

    DeviceClock();
    explicit DeviceClock(const TParams& params);

    /** Call for every image of the stream that carries the stamps, in order. */
    void observe(const ClockReading& reading);

    /** From now on the offset moves slowly (maxSlew). */
    void lock() { locked_ = true; }

    /** [s] UTC of a device time near the latest observation. */
    [[nodiscard]] double utc(double deviceTime) const { return deviceTime + offset_; }

    /** How often the device's clock jumped (camera reset); the mapping started again each time. */
    [[nodiscard]] std::size_t numJumps() const { return numJumps_; }

    /** Drift of the host's clock against the device's since lock() [s/s]; needs a minute to mean
     * something. */
    [[nodiscard]] double drift() const;

 private:
    void restart(const ClockReading& reading);
    void updateSmallestDelay(const ClockReading& reading);

    TParams params_;
    bool locked_{false};
    bool started_{false};
    ClockReading last_;
    double offset_{0};
    double bucketStart_{0};  // device time at which the current half window began
    double currentMin_{0}, previousMin_{0};
    double offsetAtStart_{0}, deviceAtStart_{0};
    std::size_t numJumps_{0};
};
}  // namespace pointplane
