// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/pose/PoseSolver.h>
#include <pointplane/pose/residuals.h>

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

/** Steps below a hundredth of a millimetre or of a milliradian end the search. */
constexpr double kStepTolerance = 1e-5;

/** Keeps what nothing determines finite. */
constexpr double kDamping = 1e-9;

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

/** Normal equations of one feature type in pose and velocity: H = J^T w W J, g = J^T w W r, and for
 * the sandwich M = J^T w^2 W Sigma W J. */
struct Normal
{
    Matrix12d H{Matrix12d::Zero()};
    Matrix12d M{Matrix12d::Zero()};
    Vector12d g{Vector12d::Zero()};
    double cost{0};
    double weightedChi2{0}, weightSum{0};
    int numInliers{0};
};

/** One evaluation of all residuals at a motion. */
class System
{
 public:
    System(
        const PoseSolver::TParams& params,
        const std::vector<PointPair>& points,
        const std::vector<PlanePair>& planes,
        const NoiseFactors& noise)
        : params_(params),
          points_(points),
          planes_(planes),
          noise_(noise)
    {
    }

    /** \param updateScale re-estimates the robust scale of the points at this motion */
    void evaluate(const Motion& motion, bool updateScale)
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
        if (updateScale)
        {
            estimateScale();
        }
        accumulate();
    }

    [[nodiscard]] const Normal& points() const { return normalPoints_; }
    [[nodiscard]] const Normal& planes() const { return normalPlanes_; }

 public:
    void push(const Residual& residual)
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

    void estimateScale()
    {
        if (points_.empty())
        {
            return;
        }
        std::vector<double> norms(
            squaredNorms_.begin(),
            squaredNorms_.begin() + static_cast<std::ptrdiff_t>(points_.size()));
        const auto middle = norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2);
        std::nth_element(norms.begin(), middle, norms.end());
        // Below one only by chance or by a pessimistic noise model: never tighten the gate for it.
        scale_ =
            std::max(params_.weighting == "none" ? 0.1 : 1.0, std::sqrt(*middle / kMedianChi2Of3));
    }

    /** Weight and cost of a squared Mahalanobis norm. */
    [[nodiscard]] std::pair<double, double> robust(double squaredNorm, bool isPoint) const
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

    void add(Normal& normal, size_t i, bool isPoint, double gain, double factor) const
    {
        const auto& [residual, W] = residuals_[i];
        const auto [w, cost] = robust(squaredNorms_[i], isPoint);
        normal.cost += gain * cost;
        normal.weightedChi2 += w * squaredNorms_[i];
        normal.weightSum += w;
        normal.numInliers += w > 0.5 ? 1 : 0;
        if (w > 0)
        {
            Eigen::Matrix<double, 3, 12> J;
            J << residual.J, residual.J_V;
            const Eigen::Matrix<double, 12, 3> JtW = J.transpose() * W;
            normal.H += gain * w * JtW * J;
            normal.g += gain * w * JtW * residual.r;
            normal.M += factor * gain * gain * w * w * JtW * residual.cov * JtW.transpose();
        }
    }

    void accumulate()
    {
        normalPoints_ = {};
        normalPlanes_ = {};
        for (size_t i = 0; i < residuals_.size(); ++i)
        {
            if (i < points_.size())
            {
                add(normalPoints_, i, true, 1 / noise_.points, noise_.points);
            }
            else
            {
                add(normalPlanes_, i, false, params_.alpha / noise_.planes, noise_.planes);
            }
        }
    }

    const PoseSolver::TParams& params_;
    const std::vector<PointPair>& points_;
    const std::vector<PlanePair>& planes_;
    NoiseFactors noise_;
    std::vector<std::pair<Residual, Eigen::Matrix3d>> residuals_;
    std::vector<double> squaredNorms_;
    double scale_{1};
    Normal normalPoints_, normalPlanes_;
};
}  // namespace

void PoseSolver::TParams::check() const
{
    POINTPLANE_CHECK(
        weighting == "full" || weighting == "diagonal" || weighting == "none",
        "weighting = " << weighting << " is none of full, diagonal, none");
    POINTPLANE_CHECK(
        planeResidual == "minimal" || planeResidual == "closestPoint",
        "planeResidual = " << planeResidual << " is neither minimal nor closestPoint");
    POINTPLANE_CHECK(alpha >= 0, "alpha = " << alpha << " is negative");
    POINTPLANE_CHECK(tukeySigmas >= 0, "tukeySigmas = " << tukeySigmas << " is negative");
    POINTPLANE_CHECK(
        planeStudentDof >= 0, "planeStudentDof = " << planeStudentDof << " is negative");
    POINTPLANE_CHECK(
        priorStudentDof >= 0, "priorStudentDof = " << priorStudentDof << " is negative");
    POINTPLANE_CHECK(
        maxIterations >= 1 && maxIterations <= 1000,
        "maxIterations = " << maxIterations << " is not in 1..1000");
}

PoseSolver::PoseSolver(const TParams& params) : params_(params) { params_.check(); }

Matrix12d PoseSolver::priorInformation(const MotionPrior& prior, const Motion& motion) const
{
    const Vector6d r = prior.residual(motion).head<6>();
    const double dof = params_.priorStudentDof;
    Matrix12d out = prior.velocityGivenPose;
    out.topLeftCorner<6, 6>() +=
        (dof > 0 ? std::min(1.0, (dof + 6) / (dof + r.dot(prior.pose * r))) : 1.0) * prior.pose;
    return out;
}

double PoseSolver::priorCost(const MotionPrior& prior, const Motion& motion) const
{
    const Vector12d r = prior.residual(motion);
    const double dof = params_.priorStudentDof;
    double norm2 = r.head<6>().dot(prior.pose * r.head<6>());
    if (dof > 0 && norm2 > 6)
    {
        norm2 = 6 + (dof + 6) * std::log((dof + norm2) / (dof + 6));
    }
    return norm2 + r.dot(prior.velocityGivenPose * r);
}

PoseEstimate PoseSolver::solve(
    const std::vector<PointPair>& points,
    const std::vector<PlanePair>& planes,
    const Eigen::Isometry3d& start,
    const std::optional<PoseGaussian>& prior) const
{
    MotionPrior motionPrior = MotionPrior::fixedVelocity({start, Vector6d::Zero()});
    if (prior)
    {
        motionPrior.mean.T_base_cur = prior->mean;
        motionPrior.pose = prior->cov.ldlt().solve(Matrix6d::Identity());
    }
    return solve(points, planes, Motion{start, Vector6d::Zero()}, motionPrior);
}

PoseEstimate PoseSolver::solve(
    const std::vector<PointPair>& points,
    const std::vector<PlanePair>& planes,
    const Motion& start,
    const MotionPrior& prior,
    const NoiseFactors& noise) const
{
    System system(params_, points, planes, noise);
    PoseEstimate out;
    Motion x = start;
    double lambda = 1e-6;
    const auto totalCost = [&](const Motion& motion)
    {
        return system.points().cost + system.planes().cost + priorCost(prior, motion);
    };
    for (out.iterations = 0; out.iterations < params_.maxIterations && !out.converged;)
    {
        system.evaluate(x, true);
        const double cost = totalCost(x);
        const Matrix12d information = priorInformation(prior, x);
        const Matrix12d H = system.points().H + system.planes().H + information;
        const Vector12d g =
            system.points().g + system.planes().g - information * prior.residual(x);
        for (bool accepted = false; !accepted && out.iterations < params_.maxIterations;)
        {
            ++out.iterations;
            Matrix12d damped = H;
            damped.diagonal() += lambda * H.diagonal() + Vector12d::Constant(kDamping);
            const Vector12d step = -damped.ldlt().solve(g);
            const Motion candidate{
                se3Exp(step.head<6>()) * x.T_base_cur, x.velocity + step.tail<6>()};
            system.evaluate(candidate, false);
            accepted = step.allFinite() && totalCost(candidate) <= cost * (1 + 1e-12);
            out.converged = step.head<3>().norm() < kStepTolerance &&
                            step.segment<3>(3).norm() < kStepTolerance;
            lambda = accepted ? std::max(1e-9, lambda * 0.1) : lambda * 10;
            if (accepted)
            {
                x = {orthonormalised(candidate.T_base_cur), candidate.velocity};
            }
            else if (out.converged || lambda > 1e8)
            {
                out.converged = true;
                break;
            }
        }
    }
    system.evaluate(x, true);
    {auto v=system.squaredNorms_; size_t np=points.size(); auto med=[](std::vector<double> a,double q){ if(a.empty()) return 0.0; std::sort(a.begin(),a.end()); return a[size_t(q*(a.size()-1))];}; std::vector<double> a(v.begin(),v.begin()+np),b(v.begin()+np,v.end());  out.pointScale=med(a,.5)/2.366;out.planeScale=med(b,.5)/2.366;}
    if (getenv("MEDS")) { auto v=system.squaredNorms_; size_t np=points.size(); auto med=[](std::vector<double> a,double q){ if(a.empty()) return 0.0; std::sort(a.begin(),a.end()); return a[size_t(q*(a.size()-1))];}; std::vector<double> a(v.begin(),v.begin()+np),b(v.begin()+np,v.end()); fprintf(stderr,"MED %zu %zu pts %.3f %.3f %.3f pl %.3f %.3f %.3f prior %.2f noise %.2f %.2f\n",a.size(),b.size(),med(a,.25)/1.213,med(a,.5)/2.366,med(a,.75)/4.108,med(b,.25)/1.213,med(b,.5)/2.366,med(b,.75)/4.108,prior.residual(x).head<6>().dot(prior.pose*prior.residual(x).head<6>()),noise.points,noise.planes); }
    const Normal& p = system.points();
    const Normal& m = system.planes();
    const Matrix12d information = priorInformation(prior, x);
    const Matrix12d H = p.H + m.H + information + kDamping * Matrix12d::Identity();
    const Matrix12d Hinv = H.ldlt().solve(Matrix12d::Identity());
    out.pointChi2PerDof = p.weightSum > 0 ? p.weightedChi2 / (3 * p.weightSum) : 0;
    out.planeChi2PerDof = m.weightSum > 0 ? m.weightedChi2 / (3 * m.weightSum) : 0;
    const Matrix12d M = p.M + m.M + information + kDamping * Matrix12d::Identity();
    out.motion = {x, propagate(Hinv, M)};
    out.infoPoints = p.H.topLeftCorner<6, 6>();
    out.infoPlanes = m.H.topLeftCorner<6, 6>();
    if (params_.alpha > 0)
    {
        out.infoPlanes /= params_.alpha;
    }
    out.numPointInliers = p.numInliers;
    return out;
}
}  // namespace pointplane
