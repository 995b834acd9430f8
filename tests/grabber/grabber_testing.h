// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <opencv2/core.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "TempDir.h"
#include "rawlog_samples.h"
#include "virtual_camera/frame_file.h"

namespace pointplane::test
{
/** Depth (CV_16UC1, mm) and colour (CV_8UC3 BGR) of one frame. */
struct PlainFrame
{
    cv::Mat depth, colour;
};

/** Frames that differ, with structure that compresses like a picture. */
inline std::vector<PlainFrame> patternFrames(int count, int width, int height)
{
    std::vector<PlainFrame> frames;
    cv::RNG random(7);
    for (int k = 0; k < count; ++k)
    {
        PlainFrame frame{cv::Mat(height, width, CV_16UC1), cv::Mat(height, width, CV_8UC3)};
        for (int y = 0; y < height; ++y)
        {
            for (int x = 0; x < width; ++x)
            {
                frame.depth.at<std::uint16_t>(y, x) =
                    static_cast<std::uint16_t>((x + y) % 37 == 0 ? 0 : 1000 + x + k);
                const auto noise = static_cast<std::uint8_t>(random.uniform(0, 8));
                frame.colour.at<cv::Vec3b>(y, x) = cv::Vec3b(
                    static_cast<std::uint8_t>(x / 4 + noise),
                    static_cast<std::uint8_t>(y / 4),
                    static_cast<std::uint8_t>(k));
            }
        }
        frames.push_back(frame);
    }
    return frames;
}

inline void writeFrameFile(
    const std::string& path, const std::vector<PlainFrame>& frames, double focal_px)
{
    FrameFileHeader header;
    header.width = frames.front().depth.cols;
    header.height = frames.front().depth.rows;
    header.numFrames = static_cast<std::int32_t>(frames.size());
    header.focal_px = focal_px;
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&header), sizeof(header));
    for (const auto& frame : frames)
    {
        const auto pixels = static_cast<std::streamsize>(frame.depth.total());
        file.write(reinterpret_cast<const char*>(frame.depth.data), pixels * 2);
        cv::Mat rgb(frame.colour.size(), CV_8UC3);
        cv::mixChannels(frame.colour, rgb, {0, 2, 1, 1, 2, 0});
        file.write(reinterpret_cast<const char*>(rgb.data), pixels * 3);
    }
}

inline cv::Mat depthOf(const mrpt::obs::CObservation3DRangeScan& scan)
{
    cv::Mat depth(
        static_cast<int>(scan.rangeImage.rows()),
        static_cast<int>(scan.rangeImage.cols()),
        CV_16UC1);
    for (int y = 0; y < depth.rows; ++y)
    {
        for (int x = 0; x < depth.cols; ++x)
        {
            depth.at<std::uint16_t>(y, x) = scan.rangeImage(y, x);
        }
    }
    return depth;
}

inline bool samePixels(const cv::Mat& a, const cv::Mat& b)
{
    return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}
}  // namespace pointplane::test
