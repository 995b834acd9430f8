// SPDX-License-Identifier: BSD-3-Clause
#include "frame_images.h"

#include <pointplane/core/counted.h>
#include <pointplane/mrpt_io/image_file.h>

#include <cstdint>
#include <cstdlib>
#include <limits>

namespace pointplane
{
cv::Mat readFrameImage(const std::string& path, int flags)
{
    try
    {
        return readImageFile(path, flags);
    }
    catch (const InputError& e)
    {
        throw BadFrame(e.what());
    }
}

cv::Mat decodedFrameImage(
    const std::vector<unsigned char>& bytes, int flags, const std::string& name)
{
    try
    {
        return decodedImage(bytes, flags, name);
    }
    catch (const InputError& e)
    {
        throw BadFrame(e.what());
    }
}

void requireColour(const std::string& path)
{
    cv::Mat image;
    try
    {
        image = readImageFile(path, cv::IMREAD_UNCHANGED);
    }
    catch (const InputError&)
    {
        return;
    }
    if (image.type() == CV_16UC1)
    {
        throw InputError(
            path + ": is listed as colour, but is of " + typeText(image) +
            ", as images of depth are");
    }
}

std::string sizeText(const cv::Size& size)
{
    return std::to_string(size.width) + "x" + std::to_string(size.height);
}

std::string typeText(const cv::Mat& image)
{
    const bool isFloat = image.depth() == CV_32F || image.depth() == CV_64F;
    return std::to_string(8 * image.elemSize1()) + (isFloat ? " bit in floating point" : " bit") +
           " and " + counted(static_cast<std::size_t>(image.channels()), "channel");
}

void setFloatDepth(RecordedFrame& frame, const cv::Mat& depth, double unitsPerMetre)
{
    constexpr double kUnits = 4000;
    const cv::Mat metres = unitsPerMetre > 0 ? cv::Mat(depth / unitsPerMetre) : depth;
    frame.scan.depth = depthInUnits(metres, kUnits);
    frame.scan.unitsPerMetre = kUnits;
    constexpr double kFarthest = std::numeric_limits<std::uint16_t>::max() / kUnits;
    cv::Mat isTooFar;
    cv::bitwise_and(metres > kFarthest, metres < std::numeric_limits<float>::infinity(), isTooFar);
    frame.numTooFar = static_cast<std::size_t>(cv::countNonZero(isTooFar));
}

void setCameraOfRegisteredDepth(RegisteredScan& scan, const std::string& where)
{
    PinholeCamera camera =
        scan.camera.scaled(static_cast<double>(scan.depth.cols) / scan.camera.width);
    if (std::abs(camera.height - scan.depth.rows) > 1)
    {
        throw BadFrame(
            where + "depth is " + sizeText(scan.depth.size()) + " and colour " +
            sizeText(scan.colour.size()) + ", which are different views");
    }
    camera.height = scan.depth.rows;  // which is rounded
    camera.distortion = {};
    scan.depthCamera = DepthCamera{camera, Eigen::Isometry3d::Identity()};
}
}  // namespace pointplane
