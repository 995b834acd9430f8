// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <string>
#include <vector>

#include "Recording.h"

namespace pointplane
{
/** An image of a frame. \throws BadFrame naming the file */
[[nodiscard]] cv::Mat readFrameImage(const std::string& path, int flags);

/** The same for its bytes. \param name of them */
[[nodiscard]] cv::Mat decodedFrameImage(
    const std::vector<unsigned char>& bytes, int flags, const std::string& name);

/** Lists are easily mixed up. \throws InputError if the image is one of depth: 16 bit and one
 * channel. One that cannot be read is left to its reader */
void requireColour(const std::string& path);

/** As 640x480. */
[[nodiscard]] std::string sizeText(const cv::Size& size);

/** As "8 bit and 3 channels". */
[[nodiscard]] std::string typeText(const cv::Mat& image);

/** Depth that comes in floating point, in quarters of a millimetre up to 16 m.
 * \param unitsPerMetre of it; 0: metres */
void setFloatDepth(RecordedFrame& frame, const cv::Mat& depth, double unitsPerMetre);

/** Registered depth of another size than colour is as colour's camera sees it, without distortion.
 * \throws BadFrame that begins with `where` if the two are different views */
void setCameraOfRegisteredDepth(RegisteredScan& scan, const std::string& where);
}  // namespace pointplane
