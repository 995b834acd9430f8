// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/DepthNoiseLearner.h>

#include <Eigen/Core>

#include <vector>

namespace pointplane
{
using NoiseAtDepth = DepthNoiseLearner::NoiseAtDepth;

/** @name How noise depends on the depth
 * Near readings alone tell nothing of how it grows.
 * @{ */

constexpr double kNearestStep = 0.75;  //!< nearer, millimetres are coarser than disparities [m]
constexpr double kLeastSigma = 1e-6;   //!< [m]

/** Those that are farther than kNearestStep. */
[[nodiscard]] std::vector<NoiseAtDepth> farOf(std::vector<NoiseAtDepth> depths);

/** Mean logarithm of the noise over that of structured light. \param depths at least one
 * \return as a factor */
[[nodiscard]] double noiseLevelOf(
    const std::vector<NoiseAtDepth>& depths, double sigmaInverseDepth);

/** By the slope of a line through the logarithms; also where depths do not spread enough to tell.
 */
[[nodiscard]] bool growsLikeTriangulation(const std::vector<NoiseAtDepth>& depths);

/** Least squares of sigma^2 = constant + slope z^4, relative to what is measured. */
class VarianceFit
{
 public:
    explicit VarianceFit(const std::vector<NoiseAtDepth>& depths);

    [[nodiscard]] double constantAlone() const { return A(0, 0) > 0 ? b(0) / A(0, 0) : 0; }
    [[nodiscard]] double slopeAlone() const { return A(1, 1) > 0 ? b(1) / A(1, 1) : 0; }

    /** Constant and slope, neither of them negative. */
    [[nodiscard]] Eigen::Vector2d solution() const;

 private:
    Eigen::Matrix2d A{Eigen::Matrix2d::Zero()};
    Eigen::Vector2d b{Eigen::Vector2d::Zero()};
};
/** @} */
}  // namespace pointplane
