// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseSolver.h>
#include <pointplane/pose/residuals.h>

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

/** All residuals of a set of pairs at a motion. */
class NormalEquations
{
 public:
    NormalEquations(
        const PoseSolver::TParams& params,
        const std::vector<PointPair>& points,
        const std::vector<PlanePair>& planes,
        const NoiseFactors& noise);

    /** \param updateScale re-estimates the robust scale of the points at this motion */
    void evaluate(const Motion& motion, bool updateScale);

    [[nodiscard]] const FeatureSum& points() const { return pointSum_; }
    [[nodiscard]] const FeatureSum& planes() const { return planeSum_; }

    /** Median squared Mahalanobis norm over what chi-square with 3 degrees of freedom would give;
     * 0 without features. */
    [[nodiscard]] double pointVariance() const;
    [[nodiscard]] double planeVariance() const;

 private:
    void push(const Residual& residual);
    void add(FeatureSum& sum, size_t i, bool isPoint, double gain, double noise) const;
    [[nodiscard]] std::pair<double, double> robust(double squaredNorm, bool isPoint) const;
    [[nodiscard]] double relativeMedian(size_t begin, size_t end) const;

    const PoseSolver::TParams& params_;
    const std::vector<PointPair>& points_;
    const std::vector<PlanePair>& planes_;
    NoiseFactors noise_;
    std::vector<std::pair<Residual, Eigen::Matrix3d>> residuals_;  //!< and their weights W
    std::vector<double> squaredNorms_;
    double scale_{1};
    FeatureSum pointSum_, planeSum_;
};
}  // namespace pointplane
