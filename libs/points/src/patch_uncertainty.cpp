// SPDX-License-Identifier: BSD-3-Clause
#include "patch_uncertainty.h"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>

namespace pointplane
{
Eigen::Matrix2d PatchUncertainty::covariance(double limit_px) const
{
    constexpr double kUnmeasured = 1000;  // [px]
    Eigen::Vector2d sigma = sigma_px;
    for (double& s : sigma)
    {
        s = s <= limit_px ? s : kUnmeasured;
    }
    return axes * sigma.cwiseAbs2().asDiagonal() * axes.transpose();
}

Directions PatchUncertainty::measured(double limit_px) const
{
    if (worst() <= limit_px)
    {
        return axes;
    }
    return best() <= limit_px ? Directions(axes.col(1)) : Directions(2, 0);
}

Eigen::Vector2d PatchUncertainty::displacement(double limit_px) const
{
    return axes * (sigma_px.array() <= limit_px).select(ofBrightness_px, 0).matrix();
}

PatchUncertainty patchUncertainty(const Patch& patch, double noise, Brightness brightness)
{
    constexpr double kEdge = 7;
    const Eigen::Matrix2d structure = patch.structure(brightness);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> es(structure);
    PatchUncertainty out;
    out.axes = es.eigenvectors();
    for (int k = 0; k < 2; ++k)
    {
        const double lambda = es.eigenvalues()[k] - patch.structureOfNoise(noise);
        out.sigma_px[k] =
            lambda > 0 ? noise * std::sqrt(2 / lambda) : std::numeric_limits<double>::infinity();
    }
    if (brightness == Brightness::Constant)
    {
        out.ofBrightness_px =
            (-out.axes.transpose() * patch.gradients().lazyProduct(patch.greys().cast<double>()))
                .cwiseQuotient(es.eigenvalues());
    }
    if (out.worst() > kEdge * out.best())
    {
        out.sigma_px[0] = std::numeric_limits<double>::infinity();
    }
    return out;
}
}  // namespace pointplane
