// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/PlaneMoments.h>
#include <pointplane/sensor/DepthNoise.h>

#include <optional>

namespace pointplane
{
/** Decides whether pixels belong to one plane: by their residuals in inverse depth, where the noise
 * is constant or made so by weights (CellGrid::weigh()). On slanted planes lateral noise adds:
 * tolerance^2 = sigma_q^2 + (slopePx |theta_xy| / f)^2 [1/m^2]. */
struct PlanarityTest
{
    DepthNoise noise;
    double slopePx{1};     //!< lateral uncertainty of a depth reading [px]
    double bentPixels{1};  //!< so many pixels share one bending error (sigmaRelative)
    double focalLengthPx{525};
    double cellSigmas{2.5};  //!< rms residual of one cell, in tolerances
    double mergeSigmas{2};   //!< rms residual of merged cells, in tolerances
    double stepSigmas{2};    //!< rms offset of the smaller part from the joint plane, in tolerances

    /** Variance that lateral noise adds to a pixel's inverse depth [1/m^2]. */
    [[nodiscard]] double slopeSquared(const Eigen::Vector3d& theta_m) const;

    /** Sum of squared residuals that one sigma of noise makes in weighted pixels [1/m^2].
     * \param bend share of the bending error's variance that shows in them, in [0, 1] */
    [[nodiscard]] double tolerated(
        const Eigen::Vector3d& theta_m, const PlaneMoments& m, double bend) const;

    /** Share of the bending error's variance that shows in the residuals of a plane of so many
     * pixels, in [0, 1]. A smooth error looks plane where little of it is seen. */
    [[nodiscard]] double bendWithin(double numPixels) const;

    [[nodiscard]] bool isPlanarCell(const PlaneMoments& cell) const;

    /** The joint fit if two parts are one plane, else nothing.
     * \param sseA, sseB of their own fits [1/m^2] */
    [[nodiscard]] std::optional<MomentsFit> merged(
        const PlaneMoments& a, double sseA, const PlaneMoments& b, double sseB) const;
};
}  // namespace pointplane
