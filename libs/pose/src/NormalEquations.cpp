// SPDX-License-Identifier: BSD-3-Clause
#include "NormalEquations.h"

#include <pointplane/pose/median_variance.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

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

/** Of a point or a plane in both views. */
bool isFinite(
    const Eigen::Vector3d& ref,
    const Eigen::Matrix3d& refCov,
    const Eigen::Vector3d& cur,
    const Eigen::Matrix3d& curCov)
{
    return ref.allFinite() && cur.allFinite() && refCov.allFinite() && curCov.allFinite();
}
}  // namespace

NormalEquations::NormalEquations(const PoseSolver::Settings& solver, const PoseProblem& problem)
    : solver_(solver),
      points_(problem.points),
      planes_(problem.planes),
      noise_(problem.noise),
      earlier_(problem.surfaces)
{
    for (const PointPair& pair : points_)
    {
        isUsable_.push_back(isFinite(pair.ref.mean, pair.ref.cov, pair.cur.mean, pair.cur.cov));
    }
    for (const PlanePair& pair : planes_)
    {
        isUsable_.push_back(
            isFinite(pair.ref.theta_m, pair.ref.cov_m, pair.cur.theta_m, pair.cur.cov_m));
    }
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
        const double least = solver_.weighting == PoseSolver::Weighting::None ? 0.1 : 1.0;
        scale_ = widening * std::max(least, std::sqrt(robustVariance()));
    }
    countInliers();
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
        cost += gain(i) * robust(i, weighted(i, motion).squaredNorm).second;
    }
    return cost;
}

Matrix123d NormalEquations::influence(size_t i) const
{
    return gain(i) * weight(i) * jacobian(i).transpose() * residuals_[i].W;
}

Matrix312d NormalEquations::jacobian(size_t i) const
{
    Matrix312d J;
    J << residuals_[i].residual.J, residuals_[i].residual.J_V;
    return J;
}

NormalEquations::Weighted NormalEquations::weighted(size_t i, const Motion& motion) const
{
    Weighted out;
    if (!isUsable_[i])
    {
        out.squaredNorm = std::numeric_limits<double>::infinity();
        return out;
    }
    if (isPoint(i))
    {
        out.residual = pointResidual(points_[i], motion);
    }
    else
    {
        const PlanePair& pair = planes_[i - points_.size()];
        out.residual = solver_.planeResidual == PoseSolver::PlaneResidual::Minimal
                           ? planeResidualMinimal(pair, motion)
                           : planeResidualClosestPoint(pair, motion);
    }
    const Residual& residual = out.residual;
    if (solver_.weighting == PoseSolver::Weighting::Full)
    {
        out.W = residual.cov.inverse();
    }
    else if (solver_.weighting == PoseSolver::Weighting::Diagonal)
    {
        out.W = residual.cov.diagonal().cwiseInverse().asDiagonal();  // [P17, after Eq. 10]
    }
    else
    {
        out.W =
            Eigen::Matrix3d::Identity() / (kUnweightedSigma * kUnweightedSigma);  // [P17, Table 1]
    }
    out.squaredNorm = residual.r.dot(out.W * residual.r);
    return out;
}

/** Weight and cost of a squared Mahalanobis norm [P17, after Eq. 10]. */
std::pair<double, double> NormalEquations::robust(size_t i, double squaredNorm) const
{
    if (!isUsable_[i])
    {
        return {0, 0};
    }
    const double limit = solver_.params.tukeySigmas * scale_;
    const double dof = solver_.params.planeStudentDof;
    if (isPoint(i) && limit > 0)
    {
        return {tukeyWeight(squaredNorm, limit), tukeyCost(squaredNorm, limit)};
    }
    if (!isPoint(i) && dof > 0)
    {
        return {(dof + 3) / (dof + squaredNorm), (dof + 3) * std::log1p(squaredNorm / dof)};
    }
    return {1, squaredNorm};
}

void NormalEquations::countInliers()
{
    surfaces_ = earlier_;
    for (size_t i = 0; i < points_.size(); ++i)
    {
        if (const size_t surface = surfaceOf(i); surface < surfaces_.size())
        {
            surfaces_[surface].points += 1;
            surfaces_[surface].inliers += weight(i);
        }
    }
}

/** Index into surfaces(); beyond its end for a pair on none of them. */
size_t NormalEquations::surfaceOf(size_t i) const
{
    return static_cast<size_t>(
        isPoint(i) ? points_[i].surface : planes_[i - points_.size()].feature);
}

double NormalEquations::ofSurface(size_t i) const
{
    const size_t surface = surfaceOf(i);
    return surface < surfaces_.size() ? surfaces_[surface].value() : 1;
}

double NormalEquations::gain(size_t i) const
{
    const double g = isPoint(i) ? 1 / noise_.points : solver_.params.alpha / noise_.planes;
    return ofSurface(i) * g;  // [P17 Eq. 10]
}

int NormalEquations::dof(size_t i) const
{
    return isPoint(i) ? points_[i].dof() : PlanePair::dof();
}

/** Squared norm over the median of those of its kind. */
double NormalEquations::relativeNorm(size_t i) const
{
    return residuals_[i].squaredNorm / medianChi2(dof(i));
}

void NormalEquations::add(FeatureSum& sum, size_t i) const
{
    if (!isUsable_[i])
    {
        return;
    }
    const auto& [residual, W, squaredNorm] = residuals_[i];
    const auto [w, cost] = robust(i, squaredNorm);
    const double noise = isPoint(i) ? noise_.points : noise_.planes;
    const double g = gain(i);
    sum.cost += g * cost;
    sum.weightedChi2 += w * squaredNorm;
    sum.dof += w * dof(i);
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
        if (solver_.weighting == PoseSolver::Weighting::Full)
        {
            sum.M += noise * g * g * w * w * JtWJ;
        }
        else
        {
            sum.M += noise * g * g * w * w * JtW * residual.cov * JtW.transpose();
        }
    }
}

PairNorms NormalEquations::norms() const
{
    PairNorms out;
    for (size_t i = 0; i < residuals_.size(); ++i)
    {
        (isPoint(i) ? out.points : out.planes).push_back(residuals_[i].squaredNorm);
    }
    return out;
}

/** Of these residuals, those that are chosen. */
template <class IsChosen>
double NormalEquations::medianOf(size_t begin, size_t end, const IsChosen& isChosen) const
{
    std::vector<double> norms;
    for (size_t i = begin; i < end; ++i)
    {
        if (isChosen(i))
        {
            norms.push_back(relativeNorm(i));
        }
    }
    return medianVariance(norms);
}

/** Each point counts for the surface that it stands for, which grows with the square of its depth:
 * what is close and moves may have most of the points, and must not set the scale by which it is
 * told apart. With the paper's weights all points count alike. */
double NormalEquations::robustVariance() const
{
    if (solver_.weighting != PoseSolver::Weighting::Full)
    {
        return medianOf(0, points_.size(), [&](size_t i) { return isUsable(i); });
    }
    std::vector<std::pair<double, double>> normsAndSurfaces;
    for (size_t i = 0; i < points_.size(); ++i)
    {
        if (isUsable_[i])
        {
            const double z = points_[i].cur.mean.z();
            normsAndSurfaces.emplace_back(relativeNorm(i), z * z);
        }
    }
    return medianVariance(normsAndSurfaces);
}

double NormalEquations::planeVariance() const
{
    return medianOf(points_.size(), residuals_.size(), [&](size_t i) { return isUsable(i); });
}

/** What moves has residuals of its own. */
double NormalEquations::pointVariance() const
{
    return medianOf(0, points_.size(), [&](size_t i) { return weight(i) > 0; });
}

std::vector<double> NormalEquations::weights(size_t begin, size_t end) const
{
    std::vector<double> out;
    for (size_t i = begin; i < end; ++i)
    {
        out.push_back(ofSurface(i) * weight(i));
    }
    return out;
}

std::vector<double> NormalEquations::pointWeights() const { return weights(0, points_.size()); }

std::vector<double> NormalEquations::planeWeights() const
{
    return weights(points_.size(), residuals_.size());
}
}  // namespace pointplane
