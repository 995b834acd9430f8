// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include <memory>
#include <vector>

namespace pointplane
{
/** SURF (Bay et al. 2008) by dlib, on one image: detection first, descriptors of the points worth
 * it later, as they take most of the time. */
class DlibSurf
{
 public:
    explicit DlibSurf(const cv::Mat& gray);
    ~DlibSurf();

    /** Sub-pixel maxima of the Hessian determinant whose descriptor window is inside the image.
     * KeyPoint::size is 20 times SURF's scale: the side of that window. */
    [[nodiscard]] std::vector<cv::KeyPoint> detect(double threshold) const;

    /** n x 64 CV_32FC1, unit length. \param upright skip the orientation: faster and more
     * distinctive while the camera rolls less than about 15 degrees between the images */
    [[nodiscard]] cv::Mat describe(const std::vector<cv::KeyPoint>& points, bool upright) const;

 private:
    struct IntegralImage;
    std::unique_ptr<IntegralImage> integral_;
};
}  // namespace pointplane
