// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "brightness.h"

namespace pointplane
{
/** Columns: orthogonal directions in the image, none to two. */
using Directions = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::ColMajor, 2, 2>;

/** What a point of a reference image looks like: grey values and gradients of the square around it,
 * cut where the image ends. How well it is found again (patchUncertainty) and how a search moves it
 * (WarpedPatches) both follow from its structure. */
class Patch
{
 public:
    /** \param gray CV_8UC1 \param derivatives CV_16SC2, Scharr's (OpenCV's pyramids), gain 32
     * \param centre inside the image [px] \param halfPx 2 halfPx + 1 pixels a side */
    Patch(const cv::Mat& gray, const cv::Mat& derivatives, const cv::Point2f& centre, int halfPx);

    /** The smaller square around the same point. \pre halfPx is at most this patch's */
    [[nodiscard]] Patch inner(int halfPx) const;

    [[nodiscard]] const cv::Point2f& centre() const { return centre_; }
    [[nodiscard]] int halfPx() const { return halfPx_; }
    [[nodiscard]] const cv::Rect& pixels() const { return pixels_; }

    /** [grey], row by row */
    [[nodiscard]] const Eigen::VectorXf& greys() const { return greys_; }

    /** [grey/px], a column a pixel, row by row */
    [[nodiscard]] const Eigen::Matrix2Xd& gradients() const { return gradients_; }

    /** The part of each gradient that a shift of brightness explains [grey/px]: the mean where one
     * is solved for, else none. */
    [[nodiscard]] Eigen::Vector2d explained(Brightness brightness) const;

    /** Sum of g g^T over the gradients g [grey^2/px^2], without what a shift of brightness
     * explains: the normal matrix of a search for the patch. */
    [[nodiscard]] Eigen::Matrix2d structure(Brightness brightness) const;

    /** What white noise adds to structure() in each direction, on average [grey^2/px^2].
     * \param noise standard deviation [grey] */
    [[nodiscard]] double structureOfNoise(double noise) const;

 private:
    Patch() = default;

    cv::Point2f centre_;
    int halfPx_{0};
    cv::Rect pixels_;
    Eigen::VectorXf greys_;
    Eigen::Matrix2Xd gradients_;
};
}  // namespace pointplane
