// SPDX-License-Identifier: BSD-3-Clause
#include "scan_images.h"

#include <pointplane/mrpt_io/ScanWriter.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>

namespace pointplane
{
namespace
{
constexpr float kNoDepth = std::numeric_limits<float>::quiet_NaN();

/** Hot pixels are full whatever the camera sees: so few do not tell how many bits it has. */
constexpr double kHotPixels = 0.001;

int numAbove(const cv::Mat& image, int brightest)
{
    return cv::countNonZero(image.reshape(1) > brightest);
}
}  // namespace

void requireUsable(bool condition, const std::string& problem)
{
    if (!condition)
    {
        throw FrameProblem(problem);
    }
}

std::string problemOfPose(const Eigen::Isometry3d& T, const std::string& name)
{
    constexpr double kLongestArm = 1e4;  // [m]; covariances lose their last digits beyond
    return !T.matrix().allFinite() ? name + " is not finite"
           : !T.linear().isUnitary(1e-4) || T.linear().determinant() < 0
               ? name + " has no rotation matrix"
           : T.translation().norm() >= kLongestArm ? name + " is longer than 10 km"
                                                   : "";
}

cv::Mat grayOf(const cv::Mat& image, int& bits)
{
    cv::Mat bytes = image;
    if (image.depth() == CV_16U)
    {
        const double few = kHotPixels * static_cast<double>(image.total());
        while (bits < 16 && numAbove(image, (1 << bits) - 1) > few)
        {
            bits += 2;
        }
        image.convertTo(bytes, CV_8U, 256.0 / (1 << bits));
    }
    requireUsable(bytes.depth() == CV_8U, "intensity image is neither 8 nor 16 bit");
    cv::Mat gray;
    switch (bytes.channels())
    {
        case 1:
            return bytes.clone();
        case 3:
            cv::cvtColor(bytes, gray, cv::COLOR_BGR2GRAY);
            return gray;
        case 4:
            cv::cvtColor(bytes, gray, cv::COLOR_BGRA2GRAY);
            return gray;
        default:
            throw FrameProblem("intensity image has neither 1 nor 3 nor 4 channels");
    }
}

cv::Mat depthInMetres(const mrpt::math::CMatrix_u16& raw, float units)
{
    const int rows = static_cast<int>(raw.rows()), cols = static_cast<int>(raw.cols());
    cv::Mat depth(rows, cols, CV_32FC1);
    for (int v = 0; v < rows; ++v)
    {
        const std::uint16_t* in = raw.data() + static_cast<std::ptrdiff_t>(v) * cols;
        auto* out = depth.ptr<float>(v);
        for (int u = 0; u < cols; ++u)
        {
            const bool isReading = in[u] != 0 && in[u] != kSaturatedDepth;
            out[u] = isReading ? static_cast<float>(in[u]) * units : kNoDepth;
        }
    }
    return depth;
}

void rangesToDepths(const PinholeCamera& camera, cv::Mat& depth)
{
    for (int v = 0; v < depth.rows; ++v)
    {
        for (int u = 0; u < depth.cols; ++u)
        {
            const double length = camera.normalised({u, v}).homogeneous().norm();
            depth.at<float>(v, u) /= static_cast<float>(length);
        }
    }
}
}  // namespace pointplane
