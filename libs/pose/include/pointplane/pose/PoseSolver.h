// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/pose/MotionGaussian.h>
#include <pointplane/pose/pairs.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
/** True variance of the features over the propagated one. */
struct NoiseFactors
{
    double points{1};
    double planes{1};
};

/** How far groups of features, those of each reference frame, draw the pose away from where all
 * together put it. */
struct Disagreement
{
    double observed{0};  //!< squared, in units of the covariances
    double expected{0};  //!< were errors as claimed and independent; 0 = nothing to compare
};

/** On what an estimate of pose (left perturbation) and velocity depends, to first order. */
struct Sensitivity
{
    /** By reference frame: change of the estimate with a change of that frame's pose (left
     * perturbation in the base frame). */
    std::map<int, Matrix126d> references;
    /** Change with that of the prior's mean, in the order of MotionPrior::residual(). */
    Matrix12d prior{Matrix12d::Zero()};
    /** Covariance that comes from the current frame's points and planes, as propagated: without
     * the noise factors, and without the references' own errors. */
    Matrix12d points{Matrix12d::Zero()}, planes{Matrix12d::Zero()};
    /** Change with errors of the camera, by which all features err together. */
    Matrix124d camera{Matrix124d::Zero()};
};

/** How far a feature is from where the estimate puts it, and how far noise of the current frame
 * puts it there: own * w + ofPoints * w_points + ofPlanes * w_planes times curCov on average over
 * the directions, if the variance of features is w (of its kind), w_points, w_planes over curCov.
 */
struct FeatureResidual
{
    int reference{0}, inReference{-1};                //!< as in the pair
    Eigen::Vector3d r{0, 0, 0};                       //!< in the base frame [m] or [1/m]
    Eigen::Matrix3d curCov{Eigen::Matrix3d::Zero()};  //!< of the current feature, in r
    double own{1};       //!< of the feature itself, less what the estimate follows it
    double ofPoints{0};  //!< of all points, by the estimate
    double ofPlanes{0};  //!< of all planes, by the estimate
};

/** What the solver found. */
struct PoseEstimate
{
    MotionGaussian motion;  //!< cov is H^-1 M H^-1, see docs/theory.md
    [[nodiscard]] PoseGaussian pose() const { return motion.pose(); }

    Matrix6d infoPoints{Matrix6d::Zero()};  //!< J^T W J of the points on the pose
    Matrix6d infoPlanes{Matrix6d::Zero()};  //!< of the planes, alpha not included
    double pointChi2PerDof{0};  //!< mean squared Mahalanobis norm / 3 of points, Tukey-weighted
    double planeChi2PerDof{0};  //!< mean squared Mahalanobis norm / 3 of planes
    double pointVariance{0};    //!< of points over the propagated one, from the median; 0 = none
    double planeVariance{0};    //!< of planes, likewise
    Disagreement pointDisagreement;  //!< of the references' points, with all other features
    Disagreement planeDisagreement;  //!< of their planes, likewise
    Sensitivity sensitivity;
    std::vector<FeatureResidual> pointResiduals, planeResiduals;  //!< of the pairs
    int numPointInliers{0};  //!< points with a Tukey weight above 1/2
    int iterations{0};
    bool converged{false};
};

/** Motion from pairs of uncertain points and planes: Levenberg-Marquardt on SE(3) over
 * E = sum_i rho(|P_i|^2) + alpha sum_j |C_j|^2 + |prior|^2 [P17 Eq. 10], the weights recomputed
 * from the propagated covariances at each iteration. */
class PoseSolver
{
 public:
    struct TParams
    {
        std::string weighting{"full"};
        std::string planeResidual{"minimal"};
        double alpha{1.0};
        double tukeySigmas{4.7};
        double planeStudentDof{5.0};
        double priorStudentDof{5.0};
        int maxIterations{20};

        template <class V>
        void visit(V&& v)
        {
            v("weighting",
              weighting,
              "-",
              "full (inverse covariance), diagonal (the paper's w = 1/diag), or none");
            v("planeResidual",
              planeResidual,
              "-",
              "minimal (difference of n/d) or closestPoint (the paper's difference of d n)");
            v("alpha", alpha, "-", "weight of the planes; 0 = points only");
            v("tukeySigmas",
              tukeySigmas,
              "-",
              "points farther than this many robust sigmas have no weight; 0 = no M-estimator");
            v("planeStudentDof",
              planeStudentDof,
              "-",
              "degrees of freedom of Student's t for planes; small = robust, 0 = Gaussian (the "
              "paper)");
            v("priorStudentDof",
              priorStudentDof,
              "-",
              "degrees of freedom of Student's t for the predicted pose: small = quick to believe "
              "a jerk, 0 = Gaussian");
            v("maxIterations", maxIterations, "-", "Levenberg-Marquardt iterations");
        }
        void check() const;
    };

    explicit PoseSolver(const TParams& params);

    /** Residuals are in units of their covariances. */
    [[nodiscard]] bool isWeighted() const { return params_.weighting != "none"; }

    /** Pose and velocity. \param start initial motion \param prior what is known without the pairs
     * \pre prior and pairs must fix all directions or the covariance is that of a minimally damped
     * system */
    [[nodiscard]] PoseEstimate solve(
        const std::vector<PointPair>& points,
        const std::vector<PlanePair>& planes,
        const Motion& start,
        const MotionPrior& prior,
        const NoiseFactors& noise = {}) const;

    /** The pose alone, pairs taken at rest. \param start initial T_base_cur
     * \param prior what is known without the pairs (left covariance); absent = nothing
     * \pre without a prior, pairs must fix all six directions or the covariance is that of a
     * minimally damped system */
    [[nodiscard]] PoseEstimate solve(
        const std::vector<PointPair>& points,
        const std::vector<PlanePair>& planes,
        const Eigen::Isometry3d& start,
        const std::optional<PoseGaussian>& prior) const;

 private:
    TParams params_;
};
}  // namespace pointplane
