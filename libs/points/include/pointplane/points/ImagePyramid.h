// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <vector>

namespace pointplane
{
/** An image and its halvings (5x5 Gaussian, every second pixel): pixel p of level L lies at
 * p * 2^L of level 0. */
class ImagePyramid
{
 public:
    ImagePyramid() = default;

    /** \param image CV_8UC1, copied \param numLevels including the image itself; fewer are built
     * when they would be smaller than 16 px */
    ImagePyramid(const cv::Mat& image, int numLevels) { build(image, numLevels); }

    /** Replaces the content, reusing its memory. \throws std::invalid_argument if not CV_8UC1 */
    void build(const cv::Mat& image, int numLevels);

    [[nodiscard]] int numLevels() const { return static_cast<int>(levels_.size()); }
    [[nodiscard]] bool empty() const { return levels_.empty(); }

    /** CV_8UC1 image of a level in [0, numLevels). */
    [[nodiscard]] const cv::Mat& level(int i) const { return levels_[static_cast<size_t>(i)]; }

 private:
    std::vector<cv::Mat> levels_;
};
}  // namespace pointplane
