// SPDX-License-Identifier: BSD-3-Clause
#include "NormalEquations.h"

#include <pointplane/pose/median_variance.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pointplane
{
NormalEquations::NormalEquations(const PoseSolver::Settings& solver, const PoseProblem& problem)
    : solver_(solver), pairs_(solver, problem), noise_(problem.noise), earlier_(problem.surfaces)
{
}

void NormalEquations::evaluate(const Motion& motion, double widening)
{
    residuals_.clear();
    for (size_t i = 0; i < pairs_.size(); ++i)
    {
        residuals_.push_back(pairs_.at(i, motion));
    }
    if (pairs_.numPoints() > 0)
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
        add(pairs_.isPoint(i) ? pointSum_ : planeSum_, i);
    }
}

double NormalEquations::costAt(const Motion& motion) const
{
    double cost = 0;
    for (size_t i = 0; i < pairs_.size(); ++i)
    {
        const Eigen::Vector3d r = pairs_.residual(i, motion).r;
        cost += gain(i) * robust(i, r.dot(residuals_[i].W * r)).cost;
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

/** Of a squared Mahalanobis norm [P17, after Eq. 10]. */
RobustCost NormalEquations::robust(size_t i, double squaredNorm) const
{
    if (!isUsable(i))
    {
        return {0, 0};
    }
    const double limit = solver_.params.tukeySigmas * scale_;
    const double dof = solver_.params.planeStudentDof;
    if (pairs_.isPoint(i) && limit > 0)
    {
        return tukey(squaredNorm, limit);
    }
    if (!pairs_.isPoint(i) && dof > 0)
    {
        return student(squaredNorm, dof);
    }
    return {1, squaredNorm};
}

void NormalEquations::countInliers()
{
    surfaces_.assign(earlier_.size(), {});
    for (size_t i = 0; i < pairs_.numPoints(); ++i)
    {
        if (const size_t surface = pairs_.surfaceOf(i); surface < surfaces_.size())
        {
            surfaces_[surface].points += 1;
            surfaces_[surface].inliers += weight(i);
        }
    }
    for (size_t i = 0; i < surfaces_.size(); ++i)
    {
        surfaces_[i] = remembered(earlier_[i], surfaces_[i]);
    }
}

double NormalEquations::ofSurface(size_t i) const
{
    const size_t surface = pairs_.surfaceOf(i);
    return surface < surfaces_.size() ? surfaces_[surface].value() : 1;
}

double NormalEquations::gain(size_t i) const
{
    const double g = pairs_.isPoint(i) ? 1 / noise_.points : solver_.params.alpha / noise_.planes;
    return ofSurface(i) * g;  // [P17 Eq. 10]
}

/** Squared norm over the median of those of its kind. */
double NormalEquations::relativeSquare(size_t i) const
{
    return residuals_[i].squaredNorm / medianChi2(pairs_.dof(i));
}

void NormalEquations::add(FeatureSum& sum, size_t i) const
{
    if (!isUsable(i))
    {
        return;
    }
    const auto& [residual, W, squaredNorm] = residuals_[i];
    const auto [w, cost] = robust(i, squaredNorm);
    const double noise = pairs_.isPoint(i) ? noise_.points : noise_.planes;
    const double g = gain(i);
    sum.cost += g * cost;
    sum.weightedChi2 += w * squaredNorm;
    sum.dof += w * pairs_.dof(i);
    const bool counts = w > kCountingWeight;
    sum.numInliers += counts ? 1 : 0;
    sum.inlierWorth += counts ? ofSurface(i) : 0;
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

SquaredNorms NormalEquations::squaredNorms() const
{
    SquaredNorms out;
    for (size_t i = 0; i < residuals_.size(); ++i)
    {
        (pairs_.isPoint(i) ? out.points : out.planes).push_back(residuals_[i].squaredNorm);
    }
    return out;
}

/** Of these residuals, those that are chosen. */
template <class IsChosen>
double NormalEquations::medianOf(size_t begin, size_t end, const IsChosen& isChosen) const
{
    std::vector<double> squares;
    for (size_t i = begin; i < end; ++i)
    {
        if (isChosen(i))
        {
            squares.push_back(relativeSquare(i));
        }
    }
    return medianVariance(squares);
}

/** Each point counts for the surface that it stands for, which grows with the square of its depth:
 * what is close and moves may have most of the points, and must not set the scale by which it is
 * told apart. All points count alike with the paper's weights, and where one point outweighs all
 * others, if these could tell the six unknowns of a pose. */
double NormalEquations::robustVariance() const
{
    std::vector<std::pair<double, double>> squaresAndSurfaces;
    double sum = 0, largest = 0;
    for (size_t i = 0; i < pairs_.numPoints(); ++i)
    {
        if (isUsable(i))
        {
            const double z = pairs_.point(i).cur.mean.z();
            squaresAndSurfaces.emplace_back(relativeSquare(i), z * z);
            sum += z * z;
            largest = std::max(largest, z * z);
        }
    }
    const bool isOutvoted = squaresAndSurfaces.size() > 6 && largest > sum - largest;
    if (solver_.weighting == PoseSolver::Weighting::Full && !isOutvoted)
    {
        return medianVariance(squaresAndSurfaces);
    }
    return medianOf(0, pairs_.numPoints(), [&](size_t i) { return isUsable(i); });
}

double NormalEquations::planeVariance() const
{
    return medianOf(pairs_.numPoints(), residuals_.size(), [&](size_t i) { return isUsable(i); });
}

/** What moves has residuals of its own. */
double NormalEquations::pointVariance() const
{
    return medianOf(0, pairs_.numPoints(), [&](size_t i) { return weight(i) > 0; });
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

std::vector<double> NormalEquations::pointWeights() const { return weights(0, pairs_.numPoints()); }

std::vector<double> NormalEquations::planeWeights() const
{
    return weights(pairs_.numPoints(), residuals_.size());
}
}  // namespace pointplane
