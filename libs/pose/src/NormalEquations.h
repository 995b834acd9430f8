// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseSolver.h>
#include <pointplane/pose/residuals.h>

#include <map>
#include <utility>
#include <vector>

namespace pointplane
{
/** One feature type's share of the normal equations in pose and velocity. */
struct FeatureSum
{
    Matrix12d H{Matrix12d::Zero()};  //!< J^T w W J / f
    Matrix12d M{Matrix12d::Zero()};  //!< J^T w^2 W Sigma W J / f, for the sandwich
    Vector12d g{Vector12d::Zero()};  //!< J^T w W r / f
    double cost{0};
    double weightedChi2{0}, weightSum{0};
    int numInliers{0};
};

using Matrix312d = Eigen::Matrix<double, 3, 12>;
using Matrix123d = Eigen::Matrix<double, 12, 3>;

/** All residuals of a set of pairs at a motion. */
class NormalEquations
{
 public:
    NormalEquations(
        const PoseSolver::TParams& params,
        const std::vector<PointPair>& points,
        const std::vector<PlanePair>& planes,
        const NoiseFactors& noise);

    /** Residuals and sums at this motion; the robust scale of the points is estimated from it.
     * \param widening of that scale */
    void evaluate(const Motion& motion, double widening = 1);

    /** Cost of all pairs at another motion, with the robust scale of the latest evaluate(). */
    [[nodiscard]] double costAt(const Motion& motion) const;

    /** Cost at the latest evaluate(). */
    [[nodiscard]] double cost() const { return pointSum_.cost + planeSum_.cost; }

    [[nodiscard]] const FeatureSum& points() const { return pointSum_; }
    [[nodiscard]] const FeatureSum& planes() const { return planeSum_; }

    /** Median squared Mahalanobis norm over what chi-square with 3 degrees of freedom would give;
     * 0 without features. */
    [[nodiscard]] double pointVariance() const;
    [[nodiscard]] double planeVariance() const;

    /** The share of each reference frame in points() and planes(). */
    [[nodiscard]] std::map<int, FeatureSum> pointsByReference() const;
    [[nodiscard]] std::map<int, FeatureSum> planesByReference() const;

    /** How the gradient changes with errors of the camera. */
    [[nodiscard]] Matrix124d cameraInfluence() const;

    /** Residuals at the latest evaluate() with what noise of the current frame does to them.
     * \param ofPoints covariance of the solution that comes from currentPointNoise()
     * \param ofPlanes from currentPlaneNoise() */
    [[nodiscard]] std::vector<FeatureResidual> pointResiduals(
        const Matrix12d& H_inverse, const Matrix12d& ofPoints, const Matrix12d& ofPlanes) const;
    [[nodiscard]] std::vector<FeatureResidual> planeResiduals(
        const Matrix12d& H_inverse, const Matrix12d& ofPoints, const Matrix12d& ofPlanes) const;

    /** Covariance of the sums' gradient g by the current frame's features, as propagated. A feature
     * that is compared with several references errs in all these pairs alike. */
    [[nodiscard]] Matrix12d currentPointNoise() const;
    [[nodiscard]] Matrix12d currentPlaneNoise() const;

 private:
    /** A residual, the weight matrix that it is given, and its squared norm by that. */
    struct Weighted
    {
        Residual residual;
        Eigen::Matrix3d W;
        double squaredNorm{0};
    };

    [[nodiscard]] Weighted weighted(size_t i, const Motion& motion) const;
    [[nodiscard]] double gain(size_t i) const;
    void add(FeatureSum& sum, size_t i) const;
    [[nodiscard]] bool isPoint(size_t i) const { return i < points_.size(); }
    template <class Pairs>
    [[nodiscard]] std::map<int, FeatureSum> byReference(const Pairs& pairs, size_t offset) const;
    template <class Pairs>
    [[nodiscard]] Matrix12d currentNoise(const Pairs& pairs, size_t offset) const;
    template <class Pairs>
    [[nodiscard]] std::vector<FeatureResidual> featureResiduals(
        const Pairs& pairs,
        size_t offset,
        const Matrix12d& H_inverse,
        const Matrix12d& ofPoints,
        const Matrix12d& ofPlanes) const;
    [[nodiscard]] Matrix312d jacobian(size_t i) const;
    [[nodiscard]] Matrix123d influence(size_t i) const;
    [[nodiscard]] std::pair<double, double> robust(double squaredNorm, bool isPoint) const;
    [[nodiscard]] double relativeMedian(size_t begin, size_t end) const;

    const PoseSolver::TParams& params_;
    const std::vector<PointPair>& points_;
    const std::vector<PlanePair>& planes_;
    NoiseFactors noise_;
    std::vector<Weighted> residuals_;  //!< of the points, then of the planes
    double scale_{1};
    FeatureSum pointSum_, planeSum_;
};
}  // namespace pointplane
