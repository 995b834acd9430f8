// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/ScanWriter.h>

#include <opencv2/core/mat.hpp>

#include <string>

namespace pointplane
{
/** An image of a frame. \throws BadFrame naming the file */
[[nodiscard]] cv::Mat readFrameImage(const std::string& path, int flags);

/** As 640x480. */
[[nodiscard]] std::string sizeText(const cv::Size& size);

/** As "8 bit and 3 channels". */
[[nodiscard]] std::string typeText(const cv::Mat& image);

/** Depth that comes in floating point. \param unitsPerMetre of it; 0: metres */
void setFloatDepth(RegisteredScan& scan, const cv::Mat& depth, double unitsPerMetre);
}  // namespace pointplane
