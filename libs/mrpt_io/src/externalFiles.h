// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/CMatrixDynamic.h>

#include <opencv2/core/mat.hpp>

#include <string>

namespace pointplane
{
/** MRPT's external range file: gz or plain; uint32 rows, uint32 columns, uint16 readings. Its sizes
 * are checked against its contents first; MRPT's own loader leaves stale rows or crashes.
 * \throws InputError naming the file */
[[nodiscard]] mrpt::math::CMatrix_u16 readExternalRange(const std::string& path);

/** An image file as 8 or 16 bit, one or three channels (BGR). \throws InputError naming the file */
[[nodiscard]] cv::Mat readExternalImage(const std::string& path);
}  // namespace pointplane
