// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <optional>
#include <vector>

#include "Patch.h"

namespace pointplane
{
/** How alike a patch and a place in an image look. */
struct Likeness
{
    double zncc{0};      //!< zero-mean normalised cross-correlation; 0 where one of them is flat
    double brighter{0};  //!< the place than the patch [grey]
};

/** Finds patches of a reference image in an image that shows them turned, larger or slanted. A
 * search that only shifts a patch ends beside its place: by half a pixel for a turn of six degrees.
 * Here the image is sampled through the known map of pixels, in Gauss-Newton over the position
 * [Lucas & Kanade 1981]. */
class WarpedPatches
{
 public:
    static constexpr int kComparedPx = 9;  //!< side of the square in the middle that is compared

    /** Makes room for patches of at most this size. */
    void reserve(std::size_t patches, int halfPx);

    /** \param measured directions in which it has structure: its position is left alone in others
     */
    void add(const Patch& patch, Brightness brightness, const Directions& measured);

    /** \param image CV_8UC1 \param warp how its pixels move with those of the reference
     * \param position where the search starts, within a pixel or two; where it ends
     * \return its variance in a direction [px^2]: what does not fit in the patch, taken as noise.
     * Nothing where the patch is not all in the image or the search goes astray */
    [[nodiscard]] std::optional<double> refine(
        std::size_t patch,
        const cv::Mat& image,
        const Eigen::Matrix2d& warp,
        cv::Point2f& position) const;

    /** Compares the square in the middle, as far as there is one, with an image that shows it
     * shifted only.
     * \pre the position is 5 pixels or more inside the image */
    [[nodiscard]] Likeness compare(
        std::size_t patch, const cv::Mat& image, const cv::Point2f& position) const;

 private:
    /** A pixel of a patch. */
    struct Sample
    {
        float grey;
        Eigen::Vector2f gain;  //!< how the position changes with the image's grey value here [px]
    };
    /** Those of one patch. */
    struct Samples
    {
        cv::Rect2f pixels;  //!< first and last pixel's place from the centre [px]
        int columns, rows;
        std::size_t begin;  //!< of its samples, row by row
        bool isShifted;     //!< a shift of brightness is solved for
        double
            ofGrey;  //!< variance of the position in a direction, per that of a grey value [px^2]
    };
    /** A step of Gauss-Newton. */
    struct Step
    {
        Eigen::Vector2f shift{0, 0};    //!< in the reference's image [px]
        float sum{0}, sumOfSquares{0};  //!< of what the image is brighter than the patch [grey]
    };
    [[nodiscard]] Step step(
        const Samples& patch,
        const cv::Mat& image,
        const Eigen::Matrix2f& warp,
        const Eigen::Vector2f& position) const;

    std::vector<Samples> patches_;
    std::vector<Sample> samples_;
};
}  // namespace pointplane
