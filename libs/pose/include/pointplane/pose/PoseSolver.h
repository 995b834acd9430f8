// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/pose/InlierRatio.h>
#include <pointplane/pose/MotionGaussian.h>
#include <pointplane/pose/PoseAnalysis.h>
#include <pointplane/pose/pairs.h>

#include <string>
#include <vector>

namespace pointplane
{
/** Variance of points and planes over the propagated one. */
struct NoiseFactors
{
    double points{1};
    double planes{1};
};

/** What a motion is estimated from. */
struct PoseProblem
{
    std::vector<PointPair> points;
    std::vector<PlanePair> planes;
    MotionPrior prior;  //!< what is known without the pairs
    NoiseFactors noise;
    /** How many points of each plane (PlanePair::feature) agreed in earlier frames. A plane and the
     * points on it count as far as its points agree, then and now. Empty: all count fully. */
    std::vector<InlierRatio> surfaces{};
};

/** Squared Mahalanobis norms of residuals, in the order of the pairs. */
struct SquaredNorms
{
    std::vector<double> points, planes;
};

/** What the solver found. */
struct PoseEstimate
{
    /** With the covariance of one frame by itself (TParams::covariance). What frames err by
     * together is added by JointCovariance. */
    MotionGaussian motion;
    [[nodiscard]] PoseGaussian pose() const { return motion.pose(); }

    Matrix6d infoPoints{Matrix6d::Zero()};  //!< J^T W J of the points, as weighed [1/m^2, 1/rad^2]
    Matrix6d infoPlanes{Matrix6d::Zero()};  //!< of the planes, alpha not included
    double pointChi2PerDof{0};  //!< mean squared Mahalanobis norm per dof of points, Tukey-weighted
    double planeChi2PerDof{0};  //!< likewise of planes, weighted by Student's t
    int numPointInliers{0};     //!< points with a Tukey weight above 1/2
    double pointInlierWorth{0};  //!< the same, each counted by the weight of its surface
    int iterations{0};
    SquaredNorms squaredNorms;  //!< of the pairs' residuals at the motion
};

/** Estimates a motion from pairs of uncertain points and planes. Levenberg-Marquardt on SE(3)
 * minimises E = sum_i rho(|P_i|^2) + alpha sum_j |C_j|^2 + |prior|^2 [P17 Eq. 10], with Student's t
 * for planes and prior. Each feature's term is divided by the noise of its kind, and multiplied by
 * the share of its surface that agrees. Each iteration propagates the covariances anew to weigh the
 * residuals. */
class PoseSolver
{
 public:
    enum class Weighting
    {
        Full,
        Diagonal,
        None
    };
    enum class PlaneResidual
    {
        Minimal,
        ClosestPoint
    };
    enum class CovarianceForm
    {
        Sandwich,
        Hessian
    };

    struct TParams
    {
        std::string weighting{"full"};
        std::string planeResidual{"minimal"};
        std::string covariance{"sandwich"};
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
              "of residuals: full (inverse covariance), diagonal (the paper's w = 1/diag) or "
              "none");
            v("planeResidual",
              planeResidual,
              "-",
              "minimal (difference of n/d) or closestPoint (the paper's difference of d n)");
            v("covariance",
              covariance,
              "-",
              "of the pose: sandwich (H^-1 M H^-1, right for any weights) or hessian (the "
              "paper's H^-1)");
            v("alpha", alpha, "-", "weight of the planes; 0 = points only");
            v("tukeySigmas",
              tukeySigmas,
              "-",
              "points farther off than this many robust sigmas have no weight; 0 = all have "
              "full weight");
            v("planeStudentDof",
              planeStudentDof,
              "-",
              "degrees of freedom of Student's t for planes: small = robust, 0 = Gaussian (as "
              "in the paper)");
            v("priorStudentDof",
              priorStudentDof,
              "-",
              "degrees of freedom of Student's t for the predicted pose: small = quick to believe "
              "a jerk, 0 = Gaussian");
            v("maxIterations", maxIterations, "-", "most iterations of Levenberg-Marquardt");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    /** \throws std::invalid_argument naming the key */
    explicit PoseSolver(const TParams& params);

    /** Pose and velocity of the current camera, with their joint covariance.
     * \param start initial motion
     * \param startWidening factor on Tukey's limit in the first step. 1: what moves is left out
     * from the start. More: points that lie far off still count, for a start that may be far off;
     * what the first step leaves out does not come back. \pre prior and pairs fix all directions;
     * the variance of one that nothing fixes is huge but finite */
    [[nodiscard]] PoseEstimate solve(
        const PoseProblem& problem, const Motion& start, double startWidening = 1) const;

    /** What a solution depends on, and what it leaves unexplained. \param solution of solve() */
    [[nodiscard]] PoseAnalysis analyse(
        const PoseProblem& problem, const PoseEstimate& solution) const;

    /** By how many points the solution stands where nothing else holds it: of the directions of
     * the pose that the points know better than planes and prior together do, the effective number
     * of points in the one with the fewest. Few that agree may do so by chance.
     * \return infinity if there is no such direction */
    [[nodiscard]] double pointSupport(
        const PoseProblem& problem, const PoseEstimate& solution) const;

    /** How far the pairs are from where a motion puts them. */
    [[nodiscard]] SquaredNorms squaredNorms(const PoseProblem& problem, const Motion& motion) const;

    /** Points farther off than this many robust sigmas have no weight; 0 = all have. */
    [[nodiscard]] double tukeySigmas() const { return settings_.params.tukeySigmas; }

    /** Parameters with their words as enumerators. */
    struct Settings
    {
        TParams params;
        Weighting weighting;
        PlaneResidual planeResidual;
        CovarianceForm covariance;
    };

 private:
    Settings settings_;
};
}  // namespace pointplane
