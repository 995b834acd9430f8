// SPDX-License-Identifier: BSD-3-Clause
#include "LatestImages.h"

#include <pointplane/odometry/robot_mask.h>

#include <cstddef>
#include <cstring>
#include <utility>

#include "frame_checks.h"
#include "no_reading.h"

namespace pointplane
{
namespace
{
/** Of images with noise, the first row differs. */
bool isSame(const cv::Mat& a, const cv::Mat& b)
{
    if (a.size() != b.size() || a.type() != b.type())
    {
        return false;
    }
    const auto bytes = static_cast<std::size_t>(a.cols) * a.elemSize();
    for (int v = 0; v < a.rows; ++v)
    {
        if (std::memcmp(a.ptr(v), b.ptr(v), bytes) != 0)
        {
            return false;
        }
    }
    return true;
}

/** Leaves the memory to those who share it. */
void makeOwn(cv::Mat& image)
{
    if (image.u != nullptr && image.u->refcount > 1)
    {
        image.release();
    }
}

void keepReadings(const cv::Mat& depth, float least, float most, cv::Mat& out)
{
    out.create(depth.size(), depth.type());
    for (int v = 0; v < depth.rows; ++v)
    {
        const auto* in = depth.ptr<float>(v);
        auto* row = out.ptr<float>(v);
        for (int u = 0; u < depth.cols; ++u)
        {
            const bool isReading = in[u] >= least && in[u] <= most;  // NaN is not
            row[u] = isReading ? in[u] : kNoReading;
        }
    }
}
}  // namespace

LatestImages::LatestImages(double minDepth, double maxDepth)
    : minDepth_(static_cast<float>(minDepth)), maxDepth_(static_cast<float>(maxDepth))
{
}

void LatestImages::setMask(const cv::Mat& mask)
{
    mask_ = mask.empty() ? cv::Mat() : withoutRobot(mask);
    leftOutOf_.reset();
}

const cv::Mat& LatestImages::leftOut(const PinholeCamera& camera)
{
    if (!leftOutOf_ || !sameCamera(*leftOutOf_, camera))
    {
        leftOut_ = maskOfDepth(mask_, camera) == 0;
        leftOutOf_ = camera;
    }
    return leftOut_;
}

void LatestImages::forget()
{
    depth_.release();
    gray_.release();
}

std::string LatestImages::renew(RgbdFrame& frame)
{
    makeOwn(readings_);
    keepReadings(frame.depth, minDepth_, maxDepth_, readings_);
    if (!mask_.empty())
    {
        readings_.setTo(kNoReading, leftOut(frame.camera));
    }
    // Noise makes any two others differ.
    const bool repeatsDepth = isSame(depth_, readings_);
    const bool repeatsGray = !frame.gray.empty() && isSame(gray_, frame.gray);
    if (!repeatsDepth)
    {
        std::swap(depth_, readings_);
    }
    if (!repeatsGray && !frame.gray.empty())
    {
        makeOwn(gray_);
        frame.gray.copyTo(gray_);
    }
    frame.depth = depth_;
    const bool repeatsReadings = repeatsDepth && hasDepth(frame);
    if (repeatsDepth)
    {
        frame.depth = cv::Mat(depth_.size(), depth_.type(), kNoReading);
    }
    frame.gray = repeatsGray || frame.gray.empty() ? cv::Mat() : gray_;
    return repeatsReadings && frame.gray.empty()
               ? "its images are those of the frame before, byte for byte"
           : repeatsReadings ? "its depth image is that of the frame before, byte for byte"
           : repeatsGray     ? "its colour image is that of the frame before, byte for byte"
                             : "";
}
}  // namespace pointplane
