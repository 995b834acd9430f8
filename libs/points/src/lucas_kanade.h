// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "brightness.h"
#include "patch_template.h"

namespace pointplane
{
/** How thoroughly a patch is searched for. */
struct PatchSearch
{
    int numLevels{1};
    int maxIterations{10};
    double epsilon_px{0.03};  //!< steps below this end the search
};

/** Pyramidal Lucas-Kanade (Bouguet 2001) of its own, because with cv::calcOpticalFlowPyrLK the
 * odometry takes a fifth longer and its error on fr3/structure_notexture_far grows by a quarter:
 * that function samples the patches again for each image, and knows no shift of brightness.
 *
 * Here, patches of a reference image are sampled once, at all levels of its pyramid. A shift of
 * brightness is solved for with the position: eliminated from the normal equations, it removes the
 * mean of the patch's gradients. With constant brightness, positions are those of OpenCV to the
 * bit. */
class PatchTemplates
{
 public:
    /** \param windowPx side of the patches, below 64 */
    explicit PatchTemplates(int windowPx);

    /** Reserves memory for so many patches. */
    void reserve(std::size_t patches, std::size_t levels);

    /** \param pyramid by cv::buildOpticalFlowPyramid with this window, with derivatives
     * \param centre inside the image */
    void add(const std::vector<cv::Mat>& pyramid, const cv::Point2f& centre, Brightness brightness);

    /** \param pyramid likewise, without derivatives \param position where to start; where the
     * search ended \return whether it ended inside, on a patch with structure */
    [[nodiscard]] bool find(
        std::size_t patch,
        const std::vector<cv::Mat>& pyramid,
        const PatchSearch& search,
        cv::Point2f& position) const;

 private:
    [[nodiscard]] bool align(
        std::size_t patchAndLevel,
        const cv::Mat& image,
        const PatchSearch& search,
        cv::Point2f& position) const;

    int windowPx_;
    std::size_t templateSize_;
    std::size_t numLevels_{0};
    std::vector<NormalMatrix> normals_;  //!< level by level of each patch
    std::vector<std::int16_t> samples_;  //!< likewise: templates
};
}  // namespace pointplane
