// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/points/ImagePyramid.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace pointplane
{
namespace
{
constexpr int kMinSizePx = 16;
}

void ImagePyramid::build(const cv::Mat& image, int numLevels)
{
    POINTPLANE_CHECK(
        !image.empty() && image.type() == CV_8UC1, "an image pyramid needs an 8-bit gray image");
    POINTPLANE_CHECK(numLevels > 0, "numLevels = " << numLevels << " is not positive");
    int count = 1;
    for (int size = std::min(image.cols, image.rows) / 2; count < numLevels && size >= kMinSizePx;
         size /= 2)
    {
        ++count;
    }
    levels_.resize(static_cast<size_t>(count));
    image.copyTo(levels_[0]);
    for (size_t i = 1; i < levels_.size(); ++i)
    {
        cv::pyrDown(levels_[i - 1], levels_[i]);
    }
}
}  // namespace pointplane
