// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneFitter.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <random>

namespace pointplane
{
namespace
{
/** Positive definite inverse, or nothing when A is singular to working precision. */
std::optional<Eigen::Matrix3d> inverted(const Eigen::Matrix3d& A)
{
    const Eigen::LDLT<Eigen::Matrix3d> ldlt(A);
    const Eigen::Vector3d D = ldlt.vectorD();
    if (ldlt.info() != Eigen::Success || !(D.minCoeff() > 1e-12 * D.maxCoeff()))
    {
        return std::nullopt;
    }
    const Eigen::Matrix3d inv = ldlt.solve(Eigen::Matrix3d::Identity());
    return 0.5 * (inv + inv.transpose());
}

/** Of the planes through three drawn points that which has most inliers; nothing if no draw has a
 * plane with any. \param isInlier (point, plane) -> bool */
template <class IsInlier>
std::optional<Plane> bestDrawnPlane(
    const std::vector<Eigen::Vector3d>& points,
    const IsInlier& isInlier,
    int draws,
    std::uint32_t seed)
{
    const size_t n = points.size();
    std::mt19937 rng(seed);
    // Not std::uniform_int_distribution: its draws differ between standard libraries.
    const auto draw = [&]() { return points[rng() % n]; };
    // A vote of a few hundred pixels ranks the hypotheses as well as one of all of them.
    const size_t stride = std::max<size_t>(1, n / 500);
    std::optional<Plane> best;
    size_t bestVotes = 0;
    for (int k = 0; n >= 3 && k < draws; ++k)
    {
        const Eigen::Vector3d a = draw(), b = draw(), c = draw();
        const Eigen::Vector3d normal = (b - a).cross(c - a);
        if (normal.norm() < 1e-9)
        {
            continue;
        }
        const Plane plane{normal.normalized(), -normal.normalized().dot(a)};
        size_t votes = 0;
        for (size_t i = 0; i < n; i += stride)
        {
            votes += isInlier(points[i], plane) ? 1 : 0;
        }
        if (votes > bestVotes)
        {
            bestVotes = votes;
            best = plane;
        }
    }
    return best;
}
}  // namespace

std::optional<PlaneGaussian> fitInverseDepth(const PlaneMoments& moments, const DepthNoise& noise)
{
    const auto fit = fitPlane(moments);
    const auto inv = inverted(moments.rayMatrix());
    if (!fit || !inv || !(fit->theta_m.norm() > 0))
    {
        return std::nullopt;
    }
    const double residual2 = moments.numPixels > 3 ? fit->sse / (moments.numPixels - 3) : 0;
    const double sigma2 = std::max(residual2, noise.sigmaInverseDepth * noise.sigmaInverseDepth);
    return PlaneGaussian{fit->theta_m, sigma2 * *inv};
}

std::optional<PlaneGaussian> fitWeightedLeastSquares(
    const std::vector<Eigen::Vector3d>& points, const DepthNoise& noise)
{
    // A has no unit, its inverse is taken for 1/mm^2.
    constexpr double kMillimetres = 1000;
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& P : points)
    {
        const double sigmaZ = noise.sigmaZ(P.z());
        const double w = 1 / (sigmaZ * sigmaZ);
        A += w * P * P.transpose();  // [P17 Eq. 4]
        b -= w * P;                  // [P17 Eq. 5]
    }
    const auto cov = points.size() < 3 ? std::nullopt : inverted(A);
    if (!cov)
    {
        return std::nullopt;
    }
    return PlaneGaussian{*cov * b, kMillimetres * kMillimetres * *cov};  // [P17, after Eq. 5]
}

std::vector<std::size_t> ransacInliers(
    const std::vector<Eigen::Vector3d>& points,
    const DepthNoise& noise,
    double maxSigmas,
    int draws,
    std::uint32_t seed)
{
    const auto isInlier = [&](const Eigen::Vector3d& P, const Plane& plane)
    { return std::abs(plane.n.dot(P) + plane.d) <= maxSigmas * noise.sigmaZ(P.z()); };
    const std::optional<Plane> best = bestDrawnPlane(points, isInlier, draws, seed);
    std::vector<std::size_t> inliers;
    inliers.reserve(points.size());
    for (size_t i = 0; i < points.size(); ++i)
    {
        if (!best || isInlier(points[i], *best))
        {
            inliers.push_back(i);
        }
    }
    return inliers;
}
}  // namespace pointplane
