// SPDX-License-Identifier: BSD-3-Clause
#include "noise_at_depths.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** Exponent of the distance with which noise grows: 0 with time of flight, 2 with triangulation.
 * Depths that spread less than this (standard deviation of their logarithm) do not tell it. */
constexpr double kTriangulation = 1, kLeastSpread = 0.1;
/** Of two neighbouring bins of depth, one with 0.2 % of the cells makes the determinant 2e-2 of the
 * product of the diagonal. */
constexpr double kTwoDistances = 1e-6;
}  // namespace

std::vector<NoiseAtDepth> farOf(std::vector<NoiseAtDepth> depths)
{
    const auto isNear = [](const NoiseAtDepth& at) { return at.depth <= kNearestStep; };
    depths.erase(std::remove_if(depths.begin(), depths.end(), isNear), depths.end());
    return depths;
}

double noiseLevelOf(const std::vector<NoiseAtDepth>& depths, double sigmaInverseDepth)
{
    double sum = 0, cells = 0;
    for (const auto& [z, sigma, n] : depths)
    {
        sum += n * std::log(std::max(sigma, kLeastSigma) / (sigmaInverseDepth * z * z));
        cells += n;
    }
    return std::exp(sum / cells);
}

bool growsLikeTriangulation(const std::vector<NoiseAtDepth>& depths)
{
    double cells = 0, sumX = 0, sumXX = 0, sumY = 0, sumXY = 0;
    for (const auto& [z, sigma, n] : depths)
    {
        const double x = std::log(z), y = std::log(std::max(sigma, kLeastSigma));
        cells += n;
        sumX += n * x;
        sumXX += n * x * x;
        sumY += n * y;
        sumXY += n * x * y;
    }
    const double spread = cells * sumXX - sumX * sumX;
    return spread < std::pow(kLeastSpread * cells, 2) ||
           cells * sumXY - sumX * sumY > kTriangulation * spread;
}

VarianceFit::VarianceFit(const std::vector<NoiseAtDepth>& depths)
{
    for (const auto& [z, sigma, n] : depths)
    {
        // Near readings alone tell nothing of how the noise grows.
        const double fourth = z > kNearestStep ? z * z * z * z : 0;
        const Eigen::Vector2d x(1 / (sigma * sigma), fourth / (sigma * sigma));
        A += n * x * x.transpose();
        b += n * x;
    }
}

Eigen::Vector2d VarianceFit::solution() const
{
    // Cells of one distance do not tell how the noise grows: all but singular.
    const Eigen::Vector2d both = A.determinant() > kTwoDistances * A(0, 0) * A(1, 1)
                                     ? Eigen::Vector2d(A.inverse() * b)
                                     : Eigen::Vector2d(0, -1);
    return !(both.y() >= 0)   ? Eigen::Vector2d(constantAlone(), 0)
           : !(both.x() >= 0) ? Eigen::Vector2d(0, slopeAlone())
                              : both;
}
}  // namespace pointplane
