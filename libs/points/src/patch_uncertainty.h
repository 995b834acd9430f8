// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "Patch.h"

namespace pointplane
{
/** How far image noise moves a patch that is searched for. */
struct PatchUncertainty
{
    Eigen::Vector2d sigma_px;  //!< along the columns of axes, the larger first; may be infinite
    Eigen::Matrix2d axes;
    /** In the axes: how far beside its place the patch is found in a brighter image, per relative
     * change [px]. Little on an edge, much on a slope of brightness. */
    Eigen::Vector2d ofBrightness_px{0, 0};

    [[nodiscard]] double worst() const { return sigma_px[0]; }
    [[nodiscard]] double best() const { return sigma_px[1]; }

    /** Directions with a larger sigma than the limit count as not measured: there a search stays
     * where it began, and that does not average out. \return [px^2] */
    [[nodiscard]] Eigen::Matrix2d covariance(double limit_px) const;

    /** Directions with a sigma of at most the limit. */
    [[nodiscard]] Directions measured(double limit_px) const;

    /** ofBrightness_px in the image, in the directions that count as measured. */
    [[nodiscard]] Eigen::Vector2d displacement(double limit_px) const;
};

/** The Cramer-Rao bound sigma sqrt(2 / lambda) in each principal direction. lambda are the
 * eigenvalues of the patch's structure, less what noise adds to it. Infinite for a patch of noise,
 * and along an edge that has less than a seventh of its structure (in sigma) in that direction:
 * such structure comes from the pixel grid, the edge's bend, or the noise of its brighter side.
 * \param noise [grey] */
[[nodiscard]] PatchUncertainty patchUncertainty(
    const Patch& patch, double noise, Brightness brightness);
}  // namespace pointplane
