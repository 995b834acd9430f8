// SPDX-License-Identifier: BSD-3-Clause
#include "NormalEquations.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** Sigma of unweighted residuals; sets only the balance with the prior. */
constexpr double kUnweightedSigma = 0.01;

/** The median of chi-square with 3 degrees of freedom. */
constexpr double kMedianChi2Of3 = 2.366;

double tukeyWeight(double squaredNorm, double limit)
{
    const double u = squaredNorm / (limit * limit);
    return u < 1 ? (1 - u) * (1 - u) : 0;
}

double tukeyCost(double squaredNorm, double limit)
{
    const double u = std::min(1.0, squaredNorm / (limit * limit));
    return limit * limit / 3 * (1 - (1 - u) * (1 - u) * (1 - u));
}
}  // namespace

NormalEquations::NormalEquations(
    const PoseSolver::TParams& params,
    const std::vector<PointPair>& points,
    const std::vector<PlanePair>& planes,
    const NoiseFactors& noise)
    : params_(params), points_(points), planes_(planes), noise_(noise)
{
}

void NormalEquations::evaluate(const Motion& motion, bool updateScale)
{
    residuals_.clear();
    squaredNorms_.clear();
    for (const PointPair& pair : points_)
    {
        push(pointResidual(pair, motion));
    }
    for (const PlanePair& pair : planes_)
    {
        push(
            params_.planeResidual == "minimal" ? planeResidualMinimal(pair, motion)
                                               : planeResidualClosestPoint(pair, motion));
    }
    if (updateScale && !points_.empty())
    {
        // Below one only by chance or by a pessimistic noise model: never tighten the gate for it.
        scale_ = std::max(params_.weighting == "none" ? 0.1 : 1.0, std::sqrt(pointVariance()));
    }
    pointSum_ = {};
    planeSum_ = {};
    for (size_t i = 0; i < residuals_.size(); ++i)
    {
        if (i < points_.size())
        {
            add(pointSum_, i, true, 1, noise_.points);
        }
        else
        {
            add(planeSum_, i, false, params_.alpha, noise_.planes);
        }
    }
}

void NormalEquations::push(const Residual& residual)
{
    Eigen::Matrix3d W;
    if (params_.weighting == "full")
    {
        W = residual.cov.inverse();
    }
    else if (params_.weighting == "diagonal")
    {
        W = residual.cov.diagonal().cwiseInverse().asDiagonal();  // [P17, after Eq. 10]
    }
    else
    {
        W = Eigen::Matrix3d::Identity() / (kUnweightedSigma * kUnweightedSigma);
    }
    residuals_.push_back({residual, W});
    squaredNorms_.push_back(residual.r.dot(W * residual.r));
}

/** Weight and cost of a squared Mahalanobis norm. */
std::pair<double, double> NormalEquations::robust(double squaredNorm, bool isPoint) const
{
    const double limit = params_.tukeySigmas * scale_;
    const double dof = params_.planeStudentDof;
    if (isPoint && limit > 0)
    {
        return {tukeyWeight(squaredNorm, limit), tukeyCost(squaredNorm, limit)};
    }
    if (!isPoint && dof > 0)
    {
        return {(dof + 3) / (dof + squaredNorm), (dof + 3) * std::log1p(squaredNorm / dof)};
    }
    return {1, squaredNorm};
}

/** \param gain alpha of planes \param noise true variance over the propagated one */
void NormalEquations::add(FeatureSum& sum, size_t i, bool isPoint, double gain, double noise) const
{
    const auto& [residual, W] = residuals_[i];
    const auto [w, cost] = robust(squaredNorms_[i], isPoint);
    const double g = gain / noise;
    sum.cost += g * cost;
    sum.weightedChi2 += w * squaredNorms_[i];
    sum.weightSum += w;
    sum.numInliers += w > 0.5 ? 1 : 0;
    if (w > 0)
    {
        Eigen::Matrix<double, 3, 12> J;
        J << residual.J, residual.J_V;
        const Eigen::Matrix<double, 12, 3> JtW = J.transpose() * W;
        sum.H += g * w * JtW * J;
        sum.g += g * w * JtW * residual.r;
        sum.M += noise * g * g * w * w * JtW * residual.cov * JtW.transpose();
    }
}

double NormalEquations::relativeMedian(size_t begin, size_t end) const
{
    if (begin == end)
    {
        return 0;
    }
    std::vector<double> norms(
        squaredNorms_.begin() + static_cast<std::ptrdiff_t>(begin),
        squaredNorms_.begin() + static_cast<std::ptrdiff_t>(end));
    const auto middle = norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2);
    std::nth_element(norms.begin(), middle, norms.end());
    return *middle / kMedianChi2Of3;
}

double NormalEquations::pointVariance() const { return relativeMedian(0, points_.size()); }

double NormalEquations::planeVariance() const
{
    return relativeMedian(points_.size(), residuals_.size());
}
}  // namespace pointplane
