// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <string>

namespace pointplane
{
/** An image file as 8 or 16 bit, one or three channels (BGR). \throws InputError naming the file */
[[nodiscard]] cv::Mat readExternalImage(const std::string& path);
}  // namespace pointplane
