// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "brightness.h"
#include "warped_patches.h"

namespace pointplane
{
/** Standard deviation of an image's white noise [grey], at least that of rounding: median response
 * of the difference of two Laplacians, blind to slopes and edges [Immerkaer 1996; the median
 * instead of the mean leaves texture out]. \param gray CV_8UC1 */
[[nodiscard]] double imageNoise(const cv::Mat& gray);

/** How far image noise moves a patch that is searched for. */
struct PatchUncertainty
{
    Eigen::Vector2d sigma_px;  //!< along the columns of axes, the larger first; may be infinite
    Eigen::Matrix2d axes;
    /** In the axes: how far it is found beside its place when all is brighter, per relative change
     * [px]. Edges hardly move, on a slope it goes to where the brightness is. */
    Eigen::Vector2d ofBrightness_px{0, 0};

    [[nodiscard]] double worst() const { return sigma_px[0]; }
    [[nodiscard]] double best() const { return sigma_px[1]; }

    /** Directions with a larger sigma than the limit count as not measured at all: there a search
     * stays where it began, which is no noise that would average out. \return [px^2] */
    [[nodiscard]] Eigen::Matrix2d covariance(double limit_px) const;

    /** Those with at most the limit's sigma. */
    [[nodiscard]] Directions measured(double limit_px) const;

    /** ofBrightness_px in the image, in the directions that count as measured. */
    [[nodiscard]] Eigen::Vector2d displacement(double limit_px) const;
};

/** The Cramer-Rao bound sigma sqrt(2 / lambda) in each of the principal directions, with the
 * eigenvalues lambda of the patch's gradient matrix, less what noise itself contributes to it.
 * Infinite for a patch of noise, and along an edge whose structure is seven times that along it:
 * the rest is how the pixel grid cuts the edge, its own bend and its brighter side's noise, on
 * which a search stays where it began. \param gray CV_8UC1 \param derivatives CV_16SC2, Scharr's
 * (OpenCV's pyramids), gain 32 \param windowPx side of the patch \param noise [grey] \param
 * brightness shifted: what a shift of brightness could explain is no structure */
[[nodiscard]] PatchUncertainty patchUncertainty(
    const cv::Mat& gray,
    const cv::Mat& derivatives,
    const cv::Point2f& centre,
    int windowPx,
    double noise,
    Brightness brightness);
}  // namespace pointplane
