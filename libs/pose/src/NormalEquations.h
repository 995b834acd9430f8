// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseSolver.h>

#include <vector>

#include "PairResiduals.h"
#include "robust_cost.h"

namespace pointplane
{
/** One feature type's share of the normal equations in pose and velocity. With the noise f of the
 * type, alpha (1 for points) and the weight s of its surface, a pair has the gain
 * lambda = alpha s / f. tau is its robust weight. */
struct FeatureSum
{
    Matrix12d H{Matrix12d::Zero()};  //!< J^T lambda tau W J
    Matrix12d M{Matrix12d::Zero()};  //!< f J^T (lambda tau)^2 W Sigma W J, for the sandwich
    Vector12d g{Vector12d::Zero()};  //!< J^T lambda tau W r
    double cost{0};
    double weightedChi2{0}, dof{0};  //!< sums over the pairs, by weight
    int numInliers{0};
    double inlierWorth{0};  //!< each inlier counted by ofSurface()
};

using Matrix312d = Eigen::Matrix<double, 3, 12>;
using Matrix123d = Eigen::Matrix<double, 12, 3>;

/** Sums over all pairs of a problem at a motion. Pairs are numbered as in PairResiduals. Those that
 * are not finite count for nothing. */
class NormalEquations
{
 public:
    /** \param solver, problem must live as long as this */
    NormalEquations(const PoseSolver::Settings& solver, const PoseProblem& problem);

    /** Residuals and sums at this motion; the robust scale of the points is estimated from it.
     * \param widening of that scale */
    void evaluate(const Motion& motion, double widening = 1);

    /** Cost of all pairs at another motion, with the weight matrices and the robust scale of the
     * latest evaluate(). Those of the other motion would favour motions of larger covariances. */
    [[nodiscard]] double costAt(const Motion& motion) const;

    // At the latest evaluate():

    [[nodiscard]] double cost() const { return pointSum_.cost + planeSum_.cost; }
    [[nodiscard]] const FeatureSum& points() const { return pointSum_; }
    [[nodiscard]] const FeatureSum& planes() const { return planeSum_; }

    /** Median squared Mahalanobis norm over that of chi-square with as many degrees of freedom, of
     * points that count and of planes; 0 without features. */
    [[nodiscard]] double pointVariance() const;
    [[nodiscard]] double planeVariance() const;

    [[nodiscard]] SquaredNorms squaredNorms() const;

    /** Whether a pair can count. */
    [[nodiscard]] bool isUsable(size_t i) const { return pairs_.isUsable(i); }

    /** Squared Mahalanobis norm of a residual, over the median of chi-square. */
    [[nodiscard]] double relativeSquare(size_t i) const;

    /** Adds one residual to a sum. */
    void add(FeatureSum& sum, size_t i) const;

    [[nodiscard]] const Residual& residual(size_t i) const { return residuals_[i].residual; }
    [[nodiscard]] Matrix312d jacobian(size_t i) const;
    [[nodiscard]] const Eigen::Matrix3d& weightMatrix(size_t i) const { return residuals_[i].W; }

    /** Robust weight, by the M-estimator: tau. */
    [[nodiscard]] double weight(size_t i) const
    {
        return robust(i, residuals_[i].squaredNorm).weight;
    }

    /** How far the surface that it is on agrees with the motion, in (0, 1]. */
    [[nodiscard]] double ofSurface(size_t i) const;

    /** How much it counts for its type and its surface: lambda. */
    [[nodiscard]] double gain(size_t i) const;

    /** remembered() with the points of this frame. */
    [[nodiscard]] const std::vector<InlierRatio>& surfaces() const { return surfaces_; }

    /** Of the pairs: weight() times ofSurface(). */
    [[nodiscard]] std::vector<double> pointWeights() const;
    [[nodiscard]] std::vector<double> planeWeights() const;

    /** How the gradient changes with the residual: lambda tau J^T W. */
    [[nodiscard]] Matrix123d influence(size_t i) const;

 private:
    void countInliers();
    [[nodiscard]] RobustCost robust(size_t i, double squaredNorm) const;
    [[nodiscard]] double robustVariance() const;
    template <class IsChosen>
    [[nodiscard]] double medianOf(size_t begin, size_t end, const IsChosen& isChosen) const;
    [[nodiscard]] std::vector<double> weights(size_t begin, size_t end) const;

    const PoseSolver::Settings& solver_;
    PairResiduals pairs_;
    NoiseFactors noise_;
    const std::vector<InlierRatio>& earlier_;
    std::vector<InlierRatio> surfaces_;
    std::vector<WeightedResidual> residuals_;  //!< of the points, then of the planes
    double scale_{1};  //!< robust sigma of the points' residuals, over the propagated one
    FeatureSum pointSum_, planeSum_;
};
}  // namespace pointplane
