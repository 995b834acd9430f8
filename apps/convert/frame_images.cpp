// SPDX-License-Identifier: BSD-3-Clause
#include "frame_images.h"

#include <pointplane/core/counted.h>
#include <pointplane/mrpt_io/image_file.h>

#include "Recording.h"

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

void setFloatDepth(RegisteredScan& scan, const cv::Mat& depth, double unitsPerMetre)
{
    const cv::Mat metres = unitsPerMetre > 0 ? cv::Mat(depth / unitsPerMetre) : depth;
    scan.depth = depthInUnits(metres, kUnitsOfFloat);
    scan.unitsPerMetre = kUnitsOfFloat;
}
}  // namespace pointplane
