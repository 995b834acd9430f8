// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "ChildProcess.h"
#include "grabber_testing.h"

namespace pointplane::test
{
/** A recorded session for fakenect, libfreenect's player: INDEX.txt and a PPM or PGM file per
 * image, their names carrying the time of arrival and the Kinect's 60 MHz stamp. Depth is stored as
 * the Kinect's raw 11-bit disparities. The player's time stands still while it works
 * (played_time.cpp), so that the machine's load does not matter. */
class FakenectSession
{
 public:
    static constexpr std::uint32_t kPeriodTicks = 2'000'000;
    static constexpr std::uint32_t kColourDelayTicks = 300'000;  // 5 ms

    /** \param firstTick stamp of the first depth image; may be chosen so that the counter overflows
     * \param skipDepth number of a depth image that is missing, or -1 */
    FakenectSession(
        const std::vector<PlainFrame>& frames, std::uint32_t firstTick, int skipDepth = -1)
    {
        std::string index;
        for (std::size_t k = 0; k < frames.size(); ++k)
        {
            const auto number = static_cast<std::uint32_t>(k);
            const std::uint32_t tick = firstTick + number * kPeriodTicks;
            const double time = 1000.0 + static_cast<double>(k) / 30.0;
            if (static_cast<int>(k) != skipDepth)
            {
                index += write('d', time, tick, "P5 640 480 65535\n", rawDepth(frames[k].depth));
            }
            index += write(
                'r',
                time + 0.005,
                tick + kColourDelayTicks,
                "P6 640 480 255\n",
                rgb(frames[k].colour));
        }
        writeBytes(dir_ / "INDEX.txt", index);
    }

    [[nodiscard]] ChildProcess::Environment environment() const
    {
        const char* options = std::getenv("ASAN_OPTIONS");
        return {
            {"LD_LIBRARY_PATH", FAKENECT_FOLDER},
            {"FAKENECT_PATH", dir_ / ""},
            {"LD_PRELOAD", PLAYED_TIME},
            {"ASAN_OPTIONS",
             std::string(options == nullptr ? "" : options) + ":verify_asan_link_order=0"}};
    }

    /** The disparity that a Kinect would report, and 2047 for no reading. */
    static std::uint16_t disparity(std::uint16_t depth_mm)
    {
        return depth_mm == 0 ? std::uint16_t{2047}
                             : static_cast<std::uint16_t>(
                                   std::lround(kZeroDisparity - kDisparityMm / depth_mm));
    }
    /** The middle of the interval of depths with that disparity. */
    static double depth_mm(std::uint16_t disparity)
    {
        return kDisparityMm / (kZeroDisparity - disparity);
    }

 private:
    // 8 f b with f = 575.8 px (the infrared camera), b = 75 mm, disparities in 1/8 px.
    static constexpr double kDisparityMm = 8.0 * 575.8157 * 75.0;
    static constexpr double kZeroDisparity = 1089.4;

    static std::string rawDepth(const cv::Mat& depth)
    {
        std::string bytes;
        for (auto it = depth.begin<std::uint16_t>(); it != depth.end<std::uint16_t>(); ++it)
        {
            const std::uint16_t raw = disparity(*it);
            bytes.append(reinterpret_cast<const char*>(&raw), sizeof(raw));
        }
        return bytes;
    }
    static std::string rgb(const cv::Mat& bgr)
    {
        cv::Mat swapped(bgr.size(), CV_8UC3);
        cv::mixChannels(bgr, swapped, {0, 2, 1, 1, 2, 0});
        return {reinterpret_cast<const char*>(swapped.data), swapped.total() * 3};
    }
    std::string write(
        char type,
        double time,
        std::uint32_t tick,
        const std::string& header,
        const std::string& pixels)
    {
        char name[100];
        std::snprintf(
            name, sizeof(name), "%c-%f-%u.%s", type, time, tick, type == 'd' ? "pgm" : "ppm");
        writeBytes(dir_ / name, header + pixels);
        return std::string(name) + "\n";
    }

    TempDir dir_;
};
}  // namespace pointplane::test
