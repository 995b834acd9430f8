// SPDX-License-Identifier: BSD-3-Clause
#include "rotation_fit.h"

#include <pointplane/core/quantile.h>
#include <pointplane/core/se3.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr std::size_t kMinSightings = 10;
constexpr int kIterations = 10;
constexpr double kTukeySigmas = 4.685;
constexpr double kSigmaOfMedian = 1 / 1.1774;  //!< of the length of 2-D Gaussian residuals
constexpr double kMinSigma = 1e-6;             //!< where images and motion are exact

using Residuals = std::vector<Eigen::Vector2d>;

/** The rotation at the middle row and how it grows over the rows. */
struct RowRotation
{
    Eigen::Vector3d middle{Eigen::Vector3d::Zero()}, growth{Eigen::Vector3d::Zero()};  // [rad]

    [[nodiscard]] Eigen::Vector3d moved(const Sighting& s) const
    {
        return so3Exp(middle + s.row * growth) * s.p_cam;
    }
};

[[nodiscard]] Residuals residualsOf(
    const std::vector<Sighting>& sightings, const RowRotation& rotation)
{
    Residuals out;
    for (const Sighting& s : sightings)
    {
        out.emplace_back(s.seen - rotation.moved(s).hnormalized());
    }
    return out;
}

[[nodiscard]] double sigmaOf(const Residuals& residuals)
{
    std::vector<double> lengths;
    for (const Eigen::Vector2d& r : residuals)
    {
        lengths.push_back(r.norm());
    }
    return std::max(kSigmaOfMedian * median(std::move(lengths)), kMinSigma);
}

[[nodiscard]] double tukeyWeight(double u) { return u < 1 ? std::pow(1 - u * u, 2) : 0; }

/** Of the normalised coordinates of exp(omega) * p with respect to omega, at 0. */
[[nodiscard]] Eigen::Matrix<double, 2, 3> jacobianOf(const Eigen::Vector3d& p)
{
    const double x = p.x() / p.z(), y = p.y() / p.z();
    Eigen::Matrix<double, 2, 3> J;
    J << -x * y, 1 + x * x, -y,  //
        -1 - y * y, x * y, x;
    return J;
}
}  // namespace

std::optional<Eigen::Vector3d> fitRotation(const std::vector<Sighting>& sightings)
{
    if (sightings.size() < kMinSightings)
    {
        return std::nullopt;
    }
    RowRotation rotation;
    for (int k = 0; k < kIterations; ++k)
    {
        const Residuals residuals = residualsOf(sightings, rotation);
        const double limit = kTukeySigmas * sigmaOf(residuals);
        Matrix6d H = Matrix6d::Zero();
        Vector6d g = Vector6d::Zero();
        for (std::size_t i = 0; i < residuals.size(); ++i)
        {
            const Eigen::Matrix<double, 2, 3> J = jacobianOf(rotation.moved(sightings[i]));
            Eigen::Matrix<double, 2, 6> both;
            both << J, sightings[i].row * J;
            const double weight = tukeyWeight(residuals[i].norm() / limit);
            H += weight * both.transpose() * both;
            g += weight * both.transpose() * residuals[i];
        }
        const Eigen::SelfAdjointEigenSolver<Matrix6d> es(H);
        if (!(es.eigenvalues()[0] > 1e-6 * es.eigenvalues()[5]))
        {
            return std::nullopt;
        }
        const Vector6d step = H.ldlt().solve(g);
        rotation.middle += step.head<3>();  // rotations of a degree simply add up
        rotation.growth += step.tail<3>();
    }
    return rotation.middle;
}
}  // namespace pointplane
