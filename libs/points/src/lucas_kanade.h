// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "brightness.h"

namespace pointplane
{
/** How thoroughly a patch is searched for. */
struct PatchSearch
{
    int numLevels{1};
    int maxIterations{10};
    double epsilon_px{0.03};  //!< steps below this end the search
};

/** Patches of a reference image at all levels of its pyramid, and pyramidal Lucas-Kanade (Bouguet
 * 2001) that finds them in other images. With constant brightness, positions are those of
 * cv::calcOpticalFlowPyrLK to the bit. That function samples the patches again for each image; here
 * they are sampled once.
 *
 * A shift of brightness is solved for with the position. Eliminated from the normal equations, it
 * removes the mean of the patch's gradients; nothing else changes. */
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
    /** Normal matrix of a patch at one level. */
    struct Normal
    {
        float xx{0}, xy{0}, yy{0};
        float inverseDeterminant{0};  //!< 0 = no structure
    };
    [[nodiscard]] std::size_t templateSize() const;
    [[nodiscard]] Normal append(
        const cv::Mat& image,
        const cv::Mat& derivatives,
        const cv::Point2f& corner,
        Brightness brightness);
    [[nodiscard]] cv::Point2f correlation(
        const std::int16_t* patch, const cv::Mat& image, const cv::Point2f& corner) const;
    [[nodiscard]] bool align(
        std::size_t patchAndLevel,
        const cv::Mat& image,
        const PatchSearch& search,
        cv::Point2f& position) const;

    int windowPx_;
    std::size_t numLevels_{0};
    std::vector<Normal> normals_;        //!< level by level of each patch
    std::vector<std::int16_t> samples_;  //!< likewise; strips of eight columns, row by row
};
}  // namespace pointplane
