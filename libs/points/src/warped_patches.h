// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <vector>

#include "brightness.h"

namespace pointplane
{
/** Columns: orthogonal directions in the image, none to two. */
using Directions = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::ColMajor, 2, 2>;

/** Finds patches of a reference image in an image that shows them turned, larger or slanted. A
 * search that only shifts a patch ends beside its place: by half a pixel for a turn of six degrees.
 * Here the image is sampled through the known map of pixels, in Gauss-Newton over the position
 * [Lucas & Kanade 1981]. */
class WarpedPatches
{
 public:
    /** Makes room for patches of at most this size. */
    void reserve(std::size_t patches, int halfPx);

    /** \param gray CV_8UC1 \param derivatives CV_16SC2, Scharr's (OpenCV's pyramids), gain 32
     * \param centre inside the image \param halfPx the patch has 2 halfPx + 1 pixels a side
     * \param measured directions in which it has structure: its position is left alone in others */
    void add(
        const cv::Mat& gray,
        const cv::Mat& derivatives,
        const cv::Point2f& centre,
        int halfPx,
        Brightness brightness,
        const Directions& measured);

    /** \param image CV_8UC1 \param warp how its pixels move with those of the reference
     * \param position where the search starts, within a pixel or two; where it ends \return false
     * where the patch is not all in the image or the search goes astray */
    [[nodiscard]] bool refine(
        std::size_t patch,
        const cv::Mat& image,
        const Eigen::Matrix2d& warp,
        cv::Point2f& position) const;

 private:
    /** A pixel of a patch. */
    struct Sample
    {
        float grey;
        Eigen::Vector2f gain;  //!< how the position changes with the image's grey value here [px]
    };
    struct Patch
    {
        cv::Rect2f pixels;  //!< first and last pixel's place from the centre
        int columns, rows;
        std::size_t begin;  //!< of its samples, row by row
    };
    [[nodiscard]] Eigen::Vector2f step(
        const Patch& patch,
        const cv::Mat& image,
        const Eigen::Matrix2f& warp,
        const Eigen::Vector2f& position) const;

    std::vector<Patch> patches_;
    std::vector<Sample> samples_;
};
}  // namespace pointplane
