// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlanarityTest.h>

#include <algorithm>

namespace pointplane
{
double PlanarityTest::slopeSquared(const Eigen::Vector3d& theta_m) const
{
    const double perPixel = slopePx / focalLengthPx;
    return perPixel * perPixel * theta_m.head<2>().squaredNorm();
}

double PlanarityTest::tolerated(
    const Eigen::Vector3d& theta_m, const PlaneMoments& m, double bend) const
{
    const double sigma2 = noise.sigmaInverseDepth * noise.sigmaInverseDepth;
    const double lacking =
        noise.sigmaRelative > 0 ? (1 - bend) * noise.relativeShare(m.q / m.n) : 0;
    return sigma2 * (1 - lacking) * m.numPixels + slopeSquared(theta_m) * m.n;
}

double PlanarityTest::bendWithin(double numPixels) const
{
    // What is not linear in it grows with the square of the extent, the area.
    const double part = std::min(1.0, numPixels / bentPixels);
    return part * part;
}

bool PlanarityTest::isPlanarCell(const PlaneMoments& cell) const
{
    const auto fit = fitPlane(cell);
    return fit && fit->sse <= cellSigmas * cellSigmas *
                                  tolerated(fit->theta_m, cell, bendWithin(cell.numPixels));
}

std::optional<MomentsFit> PlanarityTest::merged(
    const PlaneMoments& a, double sseA, const PlaneMoments& b, double sseB) const
{
    const PlaneMoments joint = a + b;
    const auto fit = fitPlane(joint);
    if (!fit)
    {
        return std::nullopt;
    }
    const PlaneMoments& smaller = a.numPixels < b.numPixels ? a : b;
    // The mean error alone would let a large plane swallow a small one at an angle.
    const double step = fit->sse - sseA - sseB;
    const bool planar =
        fit->sse <= mergeSigmas * mergeSigmas *
                        tolerated(fit->theta_m, joint, bendWithin(joint.numPixels)) &&
        step <= stepSigmas * stepSigmas * tolerated(fit->theta_m, smaller, 1);
    return planar ? fit : std::nullopt;
}
}  // namespace pointplane
