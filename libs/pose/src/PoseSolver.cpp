// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/choice.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/range.h>
#include <pointplane/core/se3.h>
#include <pointplane/pose/PoseSolver.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

#include "NormalEquations.h"
#include "Solution.h"
#include "SolutionAnalysis.h"
#include "point_support.h"

namespace pointplane
{
namespace
{
/** The search ends where the next step is this part of its standard deviation. */
constexpr double kConverged = 0.01;

/** Least damping of Levenberg and Marquardt: hardly any. */
constexpr double kLeastLambda = 1e-6;

/** Keeps what nothing determines finite. */
constexpr double kDamping = 1e-9;

/** Squared Mahalanobis norm of the pose's deviation from the predicted one. */
double deviation(const MotionPrior& prior, const Vector12d& residual)
{
    return residual.head<6>().dot(prior.pose * residual.head<6>());
}

/** Student's t for the predicted pose, beyond the norm that is expected: a jerk must not be
 * smoothed away. */
struct RobustPrior
{
    const MotionPrior& prior;
    double dof;

    [[nodiscard]] bool isDoubted(double norm2) const { return dof > 0 && norm2 > 6; }

    [[nodiscard]] Matrix12d information(const Motion& motion) const
    {
        const double norm2 = deviation(prior, prior.residual(motion));
        Matrix12d out = prior.velocityGivenPose;
        out.topLeftCorner<6, 6>() +=
            (isDoubted(norm2) ? (dof + 6) / (dof + norm2) : 1.0) * prior.pose;
        return out;
    }

    [[nodiscard]] double cost(const Motion& motion) const
    {
        const Vector12d r = prior.residual(motion);
        const double norm2 = deviation(prior, r);
        const double poseCost =
            isDoubted(norm2) ? 6 + (dof + 6) * std::log((dof + norm2) / (dof + 6)) : norm2;
        return poseCost + r.dot(prior.velocityGivenPose * r);
    }
};

/** Levenberg-Marquardt [P17, section Pose estimation]. */
class Descent
{
 public:
    Descent(
        NormalEquations& equations,
        const RobustPrior& prior,
        const Motion& start,
        int maxIterations)
        : equations_(equations), prior_(prior), motion_(start), maxIterations_(maxIterations)
    {
    }

    /** One step, damped until it lowers the cost, unless it is too small to matter.
     * \param widening of the robust scale \return whether another one is worth trying */
    bool step(double widening)
    {
        equations_.evaluate(motion_, widening);
        const double cost = equations_.cost() + prior_.cost(motion_);
        const Matrix12d information = prior_.information(motion_);
        const Matrix12d H = equations_.points().H + equations_.planes().H + information;
        const Vector12d g = equations_.points().g + equations_.planes().g -
                            information * prior_.prior.residual(motion_);
        const Matrix12d regular = H + kDamping * Matrix12d::Identity();
        converged_ = g.dot(regular.ldlt().solve(g)) < kConverged * kConverged;
        for (bool accepted = false; !accepted && !isDone();)
        {
            ++iterations_;
            Matrix12d damped = regular;
            damped.diagonal() += lambda_ * H.diagonal();
            const Vector12d step = -damped.ldlt().solve(g);
            const Motion candidate{
                se3Exp(step.head<6>()) * motion_.T_prev_cur, motion_.velocity + step.tail<6>()};
            accepted = step.allFinite() &&
                       equations_.costAt(candidate) + prior_.cost(candidate) <= cost * (1 + 1e-12);
            lambda_ = accepted ? std::max(0.1 * lambda_, kLeastLambda) : 10 * lambda_;
            if (accepted)
            {
                motion_ = {orthonormalised(candidate.T_prev_cur), candidate.velocity};
            }
        }
        return !isDone();
    }

    [[nodiscard]] const Motion& motion() const { return motion_; }
    [[nodiscard]] int iterations() const { return iterations_; }
    /** Whether the search ended because of that; the equations are those of the motion then. */
    [[nodiscard]] bool converged() const { return converged_; }

 private:
    [[nodiscard]] bool isDone() const { return converged_ || iterations_ >= maxIterations_; }

    NormalEquations& equations_;
    const RobustPrior& prior_;
    Motion motion_;
    int maxIterations_;
    double lambda_{kLeastLambda};
    int iterations_{0};
    bool converged_{false};
};

/** Normal equations of pairs and prior at the motion that they were evaluated at. */
struct Linearised
{
    Linearised(const NormalEquations& equations, const RobustPrior& prior, const Motion& motion)
    {
        known = prior.information(motion) + kDamping * Matrix12d::Identity();
        H = equations.points().H + equations.planes().H + known;
        H_inverse = H.ldlt().solve(Matrix12d::Identity());
    }
    Matrix12d known;  //!< the prior's part of H
    Matrix12d H, H_inverse;
};

PoseSolver::Weighting weightingOf(const PoseSolver::TParams& params)
{
    using Weighting = PoseSolver::Weighting;
    return chosen<Weighting>(
        "weighting",
        params.weighting,
        {{"full", Weighting::Full}, {"diagonal", Weighting::Diagonal}, {"none", Weighting::None}});
}

PoseSolver::PlaneResidual planeResidualOf(const PoseSolver::TParams& params)
{
    using PlaneResidual = PoseSolver::PlaneResidual;
    return chosen<PlaneResidual>(
        "planeResidual",
        params.planeResidual,
        {{"minimal", PlaneResidual::Minimal}, {"closestPoint", PlaneResidual::ClosestPoint}});
}

PoseSolver::CovarianceForm covarianceFormOf(const PoseSolver::TParams& params)
{
    using Form = PoseSolver::CovarianceForm;
    return chosen<Form>(
        "covariance",
        params.covariance,
        {{"sandwich", Form::Sandwich}, {"hessian", Form::Hessian}});
}
}  // namespace

void PoseSolver::TParams::check() const
{
    (void)weightingOf(*this);
    (void)planeResidualOf(*this);
    (void)covarianceFormOf(*this);
    // The paper's residual is a length: in millimetres it weighs 10, in metres a million times
    // that.
    checkRange(
        "alpha", alpha, 0, planeResidualOf(*this) == PlaneResidual::ClosestPoint ? 1e8 : 1e3);
    checkRange("tukeySigmas", tukeySigmas, 0, 1000);
    checkRange("planeStudentDof", planeStudentDof, 0, 1e4);
    checkRange("priorStudentDof", priorStudentDof, 0, 1e4);
    checkRange("maxIterations", maxIterations, 1, 1000);
}

PoseSolver::PoseSolver(const TParams& params)
    : settings_{params, weightingOf(params), planeResidualOf(params), covarianceFormOf(params)}
{
    params.check();
}

PoseEstimate PoseSolver::solve(
    const PoseProblem& problem, const Motion& start, double startWidening) const
{
    const RobustPrior prior{problem.prior, settings_.params.priorStudentDof};
    NormalEquations equations(settings_, problem);
    Descent descent(equations, prior, start, settings_.params.maxIterations);
    descent.step(startWidening);
    while (descent.step(1))
    {
    }
    const Motion& x = descent.motion();
    if (!descent.converged())
    {
        equations.evaluate(x);
    }
    const Linearised at(equations, prior, x);
    const FeatureSum& p = equations.points();
    const FeatureSum& m = equations.planes();
    PoseEstimate out;
    out.iterations = descent.iterations();
    out.motion = {
        x,
        settings_.covariance == CovarianceForm::Hessian
            ? at.H_inverse  // [P17, section Pose estimation]
            : propagate(at.H_inverse, p.M + m.M + at.known)};
    out.infoPoints = p.H.topLeftCorner<6, 6>();
    out.infoPlanes = m.H.topLeftCorner<6, 6>();
    if (settings_.params.alpha > 0)
    {
        out.infoPlanes /= settings_.params.alpha;
    }
    out.pointChi2PerDof = p.dof > 0 ? p.weightedChi2 / p.dof : 0;
    out.planeChi2PerDof = m.dof > 0 ? m.weightedChi2 / m.dof : 0;
    out.numPointInliers = p.numInliers;
    out.pointInlierWorth = p.inlierWorth;
    out.squaredNorms = equations.squaredNorms();
    return out;
}

SquaredNorms PoseSolver::squaredNorms(const PoseProblem& problem, const Motion& motion) const
{
    NormalEquations equations(settings_, problem);
    equations.evaluate(motion);
    return equations.squaredNorms();
}

double PoseSolver::pointSupport(const PoseProblem& problem, const PoseEstimate& solution) const
{
    const RobustPrior prior{problem.prior, settings_.params.priorStudentDof};
    NormalEquations equations(settings_, problem);
    equations.evaluate(solution.motion.mean);
    const Linearised at(equations, prior, solution.motion.mean);
    return supportByPoints(equations, problem, at.H);
}

PoseAnalysis PoseSolver::analyse(const PoseProblem& problem, const PoseEstimate& solution) const
{
    const RobustPrior prior{problem.prior, settings_.params.priorStudentDof};
    NormalEquations equations(settings_, problem);
    equations.evaluate(solution.motion.mean);
    const Linearised at(equations, prior, solution.motion.mean);
    const Solution solved = solutionOf(equations, problem, at.H, at.H_inverse);
    PoseAnalysis out;
    out.sensitivity = sensitivityOf(solved);
    out.sensitivity.prior = at.H_inverse * at.known;
    addCamera(solved, out);
    out.pointVariance = equations.pointVariance();
    out.planeVariance = equations.planeVariance();
    out.planeResiduals = residualsOfPlanes(solved);
    out.patchResiduals = residualsOfPatches(solved, out.sensitivity);
    if (solved.points.size() + solved.planes.size() > 1)
    {
        out.pointDisagreement = disagreementOf(solved, solved.points, solution.motion.cov);
        out.planeDisagreement = disagreementOf(solved, solved.planes, solution.motion.cov);
    }
    out.turnVariance = turnVarianceOf(solved);
    out.scatter = scatterOf(solved, out.sensitivity);
    out.pointWeights = equations.pointWeights();
    out.planeWeights = equations.planeWeights();
    out.surfaces = equations.surfaces();
    return out;
}
}  // namespace pointplane
