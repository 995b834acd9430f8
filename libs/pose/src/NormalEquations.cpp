// SPDX-License-Identifier: BSD-3-Clause
#include "NormalEquations.h"

#include <pointplane/pose/median_variance.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** Sigma of unweighted residuals; sets only the balance with the prior. */
constexpr double kUnweightedSigma = 0.01;

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

/** Feature and index of all pairs, those of the same feature one after the other. */
template <class Pairs>
std::vector<std::pair<int, size_t>> sortedByFeature(const Pairs& pairs)
{
    std::vector<std::pair<int, size_t>> out;
    out.reserve(pairs.size());
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        const int own = -1 - static_cast<int>(i);
        out.emplace_back(pairs[i].feature < 0 ? own : pairs[i].feature, i);
    }
    std::sort(out.begin(), out.end());
    return out;
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

void NormalEquations::evaluate(const Motion& motion, double widening)
{
    residuals_.clear();
    for (size_t i = 0; i < points_.size() + planes_.size(); ++i)
    {
        residuals_.push_back(weighted(i, motion));
    }
    if (!points_.empty())
    {
        // Below one only by chance or by a pessimistic noise model: never tighten the gate for it.
        const double least = params_.weighting == "none" ? 0.1 : 1.0;
        scale_ = widening * std::max(least, std::sqrt(pointVariance()));
    }
    pointSum_ = {};
    planeSum_ = {};
    for (size_t i = 0; i < residuals_.size(); ++i)
    {
        add(isPoint(i) ? pointSum_ : planeSum_, i);
    }
}

double NormalEquations::costAt(const Motion& motion) const
{
    double cost = 0;
    for (size_t i = 0; i < points_.size() + planes_.size(); ++i)
    {
        cost += gain(i) * robust(weighted(i, motion).squaredNorm, isPoint(i)).second;
    }
    return cost;
}

/** \param offset of the pairs' first residual */
template <class Pairs>
std::map<int, FeatureSum> NormalEquations::byReference(const Pairs& pairs, size_t offset) const
{
    std::map<int, FeatureSum> out;
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        add(out[pairs[i].reference], offset + i);
    }
    return out;
}

std::map<int, FeatureSum> NormalEquations::pointsByReference() const
{
    return byReference(points_, 0);
}

std::map<int, FeatureSum> NormalEquations::planesByReference() const
{
    return byReference(planes_, points_.size());
}

/** How the gradient changes with the residual. */
Matrix123d NormalEquations::influence(size_t i) const
{
    const auto& [residual, W, squaredNorm] = residuals_[i];
    return gain(i) * robust(squaredNorm, isPoint(i)).first * jacobian(i).transpose() * W;
}

Matrix312d NormalEquations::jacobian(size_t i) const
{
    Matrix312d J;
    J << residuals_[i].residual.J, residuals_[i].residual.J_V;
    return J;
}

/** \param offset of the pairs' first residual */
template <class Pairs>
Matrix12d NormalEquations::currentNoise(const Pairs& pairs, size_t offset) const
{
    const auto order = sortedByFeature(pairs);
    Matrix12d out = Matrix12d::Zero();
    for (auto it = order.begin(); it != order.end();)
    {
        const int feature = it->first;
        Matrix123d ofUnitNoise = Matrix123d::Zero();
        for (; it != order.end() && it->first == feature; ++it)
        {
            const size_t i = offset + it->second;
            const Eigen::LLT<Eigen::Matrix3d> root(residuals_[i].residual.curCov);
            if (root.info() == Eigen::Success)
            {
                ofUnitNoise += influence(i) * Eigen::Matrix3d(root.matrixL());
            }
        }
        out += ofUnitNoise * ofUnitNoise.transpose();
    }
    return out;
}

/** \param offset of the pairs' first residual */
template <class Pairs>
std::vector<FeatureResidual> NormalEquations::featureResiduals(
    const Pairs& pairs,
    size_t offset,
    const Matrix12d& H_inverse,
    const Matrix12d& ofPoints,
    const Matrix12d& ofPlanes) const
{
    std::vector<FeatureResidual> out(pairs.size());
    const auto order = sortedByFeature(pairs);
    for (auto it = order.begin(); it != order.end();)
    {
        const auto begin = it;
        Matrix123d sum = Matrix123d::Zero();
        for (; it != order.end() && it->first == begin->first; ++it)
        {
            sum += influence(offset + it->second);
        }
        const Matrix123d follows = H_inverse * sum;  // the estimate, the feature
        for (auto member = begin; member != it; ++member)
        {
            const auto& pair = pairs[member->second];
            const Residual& residual = residuals_[offset + member->second].residual;
            const Matrix312d J = jacobian(offset + member->second);
            const Eigen::Matrix3d information = residual.curCov.inverse();
            const Matrix123d seen = J.transpose() * information / 3;
            out[member->second] = {
                pair.reference,
                pair.inReference,
                residual.r,
                residual.curCov,
                1 - 2.0 / 3 * J.cwiseProduct(follows.transpose()).sum(),
                seen.cwiseProduct(ofPoints * J.transpose()).sum(),
                seen.cwiseProduct(ofPlanes * J.transpose()).sum()};
        }
    }
    return out;
}

std::vector<FeatureResidual> NormalEquations::pointResiduals(
    const Matrix12d& H_inverse, const Matrix12d& ofPoints, const Matrix12d& ofPlanes) const
{
    return featureResiduals(points_, 0, H_inverse, ofPoints, ofPlanes);
}

std::vector<FeatureResidual> NormalEquations::planeResiduals(
    const Matrix12d& H_inverse, const Matrix12d& ofPoints, const Matrix12d& ofPlanes) const
{
    return featureResiduals(planes_, points_.size(), H_inverse, ofPoints, ofPlanes);
}

Matrix12d NormalEquations::currentPointNoise() const { return currentNoise(points_, 0); }

Matrix12d NormalEquations::currentPlaneNoise() const
{
    return currentNoise(planes_, points_.size());
}

Matrix124d NormalEquations::cameraInfluence() const
{
    Matrix124d out = Matrix124d::Zero();
    for (size_t i = 0; i < residuals_.size(); ++i)
    {
        const auto& [residual, W, squaredNorm] = residuals_[i];
        const double w = robust(squaredNorm, isPoint(i)).first;
        if (w > 0)
        {
            const ByCamera weighted = gain(i) * w * W * residual.ofCamera;
            out.topRows<6>() += residual.J.transpose() * weighted;
            out.bottomRows<6>() += residual.J_V.transpose() * weighted;
        }
    }
    return out;
}

NormalEquations::Weighted NormalEquations::weighted(size_t i, const Motion& motion) const
{
    Weighted out;
    if (isPoint(i))
    {
        out.residual = pointResidual(points_[i], motion);
    }
    else
    {
        const PlanePair& pair = planes_[i - points_.size()];
        out.residual = params_.planeResidual == "minimal" ? planeResidualMinimal(pair, motion)
                                                          : planeResidualClosestPoint(pair, motion);
    }
    const Residual& residual = out.residual;
    if (params_.weighting == "full")
    {
        out.W = residual.cov.inverse();
    }
    else if (params_.weighting == "diagonal")
    {
        out.W = residual.cov.diagonal().cwiseInverse().asDiagonal();  // [P17, after Eq. 10]
    }
    else
    {
        out.W = Eigen::Matrix3d::Identity() / (kUnweightedSigma * kUnweightedSigma);
    }
    out.squaredNorm = residual.r.dot(out.W * residual.r);
    return out;
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

double NormalEquations::gain(size_t i) const
{
    return isPoint(i) ? 1 / noise_.points : params_.alpha / noise_.planes;
}

void NormalEquations::add(FeatureSum& sum, size_t i) const
{
    const auto& [residual, W, squaredNorm] = residuals_[i];
    const auto [w, cost] = robust(squaredNorm, isPoint(i));
    const double noise = isPoint(i) ? noise_.points : noise_.planes;
    const double g = gain(i);
    sum.cost += g * cost;
    sum.weightedChi2 += w * squaredNorm;
    sum.weightSum += w;
    sum.numInliers += w > 0.5 ? 1 : 0;
    if (w > 0)
    {
        const Matrix312d J = jacobian(i);
        const Matrix123d JtW = J.transpose() * W;
        // A general matrix product would pack its operands.
        const Matrix12d JtWJ = JtW.lazyProduct(J);
        sum.H += g * w * JtWJ;
        sum.g += g * w * JtW * residual.r;
        // W Sigma W = W of weights that are the inverse covariance.
        if (params_.weighting == "full")
        {
            sum.M += noise * g * g * w * w * JtWJ;
        }
        else
        {
            sum.M += noise * g * g * w * w * JtW * residual.cov * JtW.transpose();
        }
    }
}

double NormalEquations::relativeMedian(size_t begin, size_t end) const
{
    std::vector<double> norms;
    for (size_t i = begin; i < end; ++i)
    {
        norms.push_back(residuals_[i].squaredNorm);
    }
    return medianVariance(norms);
}

double NormalEquations::pointVariance() const { return relativeMedian(0, points_.size()); }

double NormalEquations::planeVariance() const
{
    return relativeMedian(points_.size(), residuals_.size());
}
}  // namespace pointplane
