// SPDX-License-Identifier: BSD-3-Clause
#include "frame_changes.h"

#include <pointplane/core/check.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pointplane
{
namespace
{
constexpr float kNoDepth = std::numeric_limits<float>::quiet_NaN();

/** Mean depth of the part of a block that belongs to its nearest surface. */
[[nodiscard]] float depthOfBlock(const cv::Mat& block)
{
    constexpr float kSameSurface = 1.03F;  // depth against the block's nearest
    float nearest = std::numeric_limits<float>::infinity();
    for (int v = 0; v < block.rows; ++v)
    {
        for (int u = 0; u < block.cols; ++u)
        {
            nearest = std::fmin(nearest, block.at<float>(v, u));
        }
    }
    float sum = 0;
    int count = 0;
    for (int v = 0; v < block.rows; ++v)
    {
        for (int u = 0; u < block.cols; ++u)
        {
            const float z = block.at<float>(v, u);
            if (z <= kSameSurface * nearest)
            {
                sum += z;
                ++count;
            }
        }
    }
    return count > 0 ? sum / static_cast<float>(count) : kNoDepth;
}

/** Other numbers for each frame, the same in each run. */
[[nodiscard]] cv::RNG randomOf(const RgbdFrame& frame)
{
    return cv::RNG(static_cast<std::uint64_t>(std::llround(frame.stamp * 1e6)));
}

/** Standard normal, one per pixel. */
[[nodiscard]] cv::Mat_<float> normals(const RgbdFrame& frame)
{
    cv::Mat_<float> out(frame.depth.size());
    randomOf(frame).fill(out, cv::RNG::NORMAL, 0, 1);
    return out;
}
}  // namespace

RgbdFrame withoutDepth(const RgbdFrame& frame)
{
    RgbdFrame out = frame;
    out.depth = cv::Mat(frame.depth.size(), CV_32FC1, cv::Scalar(kNoDepth));
    return out;
}

RgbdFrame withoutColour(const RgbdFrame& frame)
{
    RgbdFrame out = frame;
    // Not cv::Mat::zeros(): assigning that would write into the given frame's image.
    out.gray = cv::Mat(frame.gray.size(), CV_8UC1, cv::Scalar(0));
    return out;
}

RgbdFrame withoutImages(const RgbdFrame& frame)
{
    RgbdFrame out = frame;
    out.gray = cv::Mat();
    out.depth = cv::Mat();
    return out;
}

RgbdFrame mirrored(const RgbdFrame& frame)
{
    constexpr int kLeftToRight = 1;
    RgbdFrame out = frame;
    // flip() would write into the given frame's images.
    out.gray = cv::Mat();
    out.depth = cv::Mat();
    cv::flip(frame.gray, out.gray, kLeftToRight);
    cv::flip(frame.depth, out.depth, kLeftToRight);
    return out;
}

RgbdFrame withDepthUpTo(const RgbdFrame& frame, float range)
{
    RgbdFrame out = frame;
    out.depth = frame.depth.clone();
    out.depth.setTo(cv::Scalar(kNoDepth), frame.depth > range);
    return out;
}

RgbdFrame withHoles(const RgbdFrame& frame, double share)
{
    cv::Mat_<float> uniform(frame.depth.size());
    randomOf(frame).fill(uniform, cv::RNG::UNIFORM, 0, 1);
    RgbdFrame out = frame;
    out.depth = frame.depth.clone();
    out.depth.setTo(cv::Scalar(kNoDepth), uniform < share);
    return out;
}

RgbdFrame withNoisyDepth(const RgbdFrame& frame, double at1m)
{
    RgbdFrame out = frame;
    out.depth = cv::Mat(frame.depth + at1m * normals(frame).mul(frame.depth.mul(frame.depth)));
    return out;
}

RgbdFrame dimmed(const RgbdFrame& frame, double light, double noise)
{
    RgbdFrame out = frame;
    out.gray = cv::Mat();
    cv::Mat_<float> brightness;
    frame.gray.convertTo(brightness, CV_32F, light);
    cv::Mat_<float> grain(brightness.size());
    randomOf(frame).fill(grain, cv::RNG::NORMAL, 0, noise);
    cv::Mat(brightness + grain).convertTo(out.gray, CV_8U);
    return out;
}

RgbdFrame withText(const RgbdFrame& frame)
{
    constexpr int kLines = 4;
    RgbdFrame out = frame;
    out.gray = frame.gray.clone();
    for (int line = 1; line <= kLines; ++line)
    {
        const cv::Point place(out.gray.cols / 32, line * out.gray.rows / (kLines + 1));
        cv::putText(
            out.gray,
            "CAM 01 2024-03-02 REC",
            place,
            cv::FONT_HERSHEY_SIMPLEX,
            out.gray.cols / 400.0,
            255,
            std::max(1, out.gray.cols / 250));
    }
    return out;
}

RgbdFrame withSpots(const RgbdFrame& frame)
{
    constexpr int kSpots = 1500, kMargin = 2;
    constexpr double kRadius_px = 1, kBrightness = 120;
    cv::Mat_<float> light(frame.gray.size(), 0.0F);
    cv::RNG random(0x9E3779B97F4A7C15);
    for (int i = 0; i < kSpots; ++i)
    {
        const int v = random.uniform(kMargin, light.rows - kMargin);
        light(v, random.uniform(kMargin, light.cols - kMargin)) = 1;
    }
    cv::GaussianBlur(light, light, {}, kRadius_px);
    cv::normalize(light, light, 0, kBrightness, cv::NORM_MINMAX);
    RgbdFrame out = frame;
    out.gray = cv::Mat();
    cv::add(frame.gray, light, out.gray, cv::noArray(), CV_8U);
    return out;
}

RgbdFrame shrunk(const RgbdFrame& frame, int factor)
{
    POINTPLANE_CHECK(factor >= 1, "factor " << factor);
    const cv::Size size(frame.camera.width / factor, frame.camera.height / factor);
    const cv::Rect used(0, 0, size.width * factor, size.height * factor);
    RgbdFrame out = frame;
    PinholeCamera& camera = out.camera;
    camera.width = size.width;
    camera.height = size.height;
    camera.fx /= factor;
    camera.fy /= factor;
    // The centre of pixel u covers columns factor u .. factor u + factor - 1.
    camera.cx = (camera.cx + 0.5) / factor - 0.5;
    camera.cy = (camera.cy + 0.5) / factor - 0.5;
    out.gray = cv::Mat();
    cv::resize(frame.gray(used), out.gray, size, 0, 0, cv::INTER_AREA);
    out.depth = cv::Mat(size, CV_32FC1);
    for (int v = 0; v < size.height; ++v)
    {
        for (int u = 0; u < size.width; ++u)
        {
            out.depth.at<float>(v, u) =
                depthOfBlock(frame.depth(cv::Rect(u * factor, v * factor, factor, factor)));
        }
    }
    return out;
}

bool showsSomething(const RgbdFrame& frame)
{
    return !frame.gray.empty() && !frame.depth.empty() && cv::countNonZero(frame.gray) > 0 &&
           cv::countNonZero(frame.depth == frame.depth) > 0;
}
}  // namespace pointplane
