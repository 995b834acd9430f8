// SPDX-License-Identifier: BSD-3-Clause
#include "Aligner.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "Stopwatch.h"

namespace pointplane
{
namespace
{
/** Search radius when too little is found again around the prediction, over the usual one. */
constexpr double kWideSearch = 5;

/** Fewer matches than this in total cannot fix a pose [P17, section Pose estimation]. */
constexpr int kMinMatches = 3;

/** So few points cannot contradict each other when they are wrong; a plane is worth three. */
constexpr int kFewPoints = 6;

/** Standard deviations from the predicted pose that they are not believed then. */
constexpr double kMostSurprise = 5;

/** How many directions the measurements know better than the motion model does. */
int observableDirections(const Matrix6d& information, const Matrix6d& priorCovariance)
{
    const Matrix6d L = priorCovariance.llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(L.transpose() * information * L);
    return static_cast<int>((es.eigenvalues().array() > 1).count());
}

/** Root mean square deviation from the predicted pose, in its standard deviations. */
double surprise(const PoseEstimate& estimate, const PoseGaussian& predicted)
{
    const Vector6d e = leftError(estimate.motion.mean.T_prev_cur, predicted.mean);
    return std::sqrt(e.dot(predicted.cov.ldlt().solve(e)) / 6);
}

double maxSigma(const Matrix6d& cov)
{
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(cov);
    return std::sqrt(std::max(0.0, es.eigenvalues().maxCoeff()));
}
}  // namespace

Aligner::Aligner(const OdometryParams& params)
    : params_(params.pipeline),
      fuses_(params.pipeline.fuses()),
      searchesAhead_(params.pipeline.searchesAhead()),
      minOverlap_(params.reference.keyframeMinOverlap),
      solver_(params.poseSolver)
{
}

Alignment Aligner::align(
    const FrontEnd& frontEnd,
    const Features& current,
    Track& track,
    const ErrorModel& errors,
    FrameDiagnostics& diagnostics) const
{
    Alignment out;
    out.predicted = track.prediction(current.frame.stamp);
    const PairBuilder pairs(track.previous(), current);
    const auto associateAt = [&](const Eigen::Isometry3d& T_prev_cur, double radiusFactor)
    { return associate(frontEnd, current, track, T_prev_cur, radiusFactor); };

    // [P17, section Matching] capitalises on small motion.
    const Eigen::Isometry3d expected =
        searchesAhead_ ? out.predicted.pose.mean : Eigen::Isometry3d::Identity();

    const Stopwatch matching;
    out.associations = associateAt(expected, 1);
    if (track.overlap(out.associations) < minOverlap_)
    {
        // A jerk that the motion model did not foresee: look farther, then closely again. Other
        // candidates for the motion, from the images alone, would be tried here.
        out.associations = associateAt(expected, kWideSearch);
        estimate(out, pairs, errors, diagnostics);
        out.associations = associateAt(out.estimate.motion.mean.T_prev_cur, 1);
    }
    diagnostics.msMatching = matching.ms();
    estimate(out, pairs, errors, diagnostics);
    judge(out, diagnostics);
    return out;
}

std::vector<Association> Aligner::associate(
    const FrontEnd& frontEnd,
    const Features& current,
    const Track& track,
    const Eigen::Isometry3d& T_prev_cur,
    double radiusFactor)
{
    std::vector<Association> out;
    const Eigen::Isometry3d T_cur_world =
        T_prev_cur.inverse() * track.previous().T_world_cam.inverse();
    for (const Reference* reference : track.references())
    {
        out.push_back(frontEnd.associate(
            *reference, current, T_cur_world * reference->T_world_cam, radiusFactor));
    }
    return out;
}

/** The paper counts points and planes; with a prediction to fuse with, any of them helps. */
int Aligner::minMatches() const { return fuses_ ? 1 : kMinMatches; }

/** From the associations; the prediction where there is too little to estimate from. */
void Aligner::estimate(
    Alignment& alignment,
    const PairBuilder& pairs,
    const ErrorModel& errors,
    FrameDiagnostics& diagnostics) const
{
    const Stopwatch watch;
    PoseProblem& problem = alignment.problem;
    pairs.build(alignment.associations, errors.shutter(), problem.points, problem.planes);
    problem.prior = alignment.predicted.prior;
    problem.noise = errors.noise();
    PoseEstimate out;
    out.motion = alignment.predicted.motion;
    if (static_cast<int>(problem.points.size() + problem.planes.size()) >= minMatches())
    {
        out = solver_.solve(problem, alignment.predicted.motion.mean);
    }
    diagnostics.iterations += out.iterations;
    diagnostics.numPointPairs = static_cast<int>(problem.points.size());
    diagnostics.numPlanePairs = static_cast<int>(problem.planes.size());
    diagnostics.numPointInliers = out.numPointInliers;
    diagnostics.pointChi2PerDof = out.pointChi2PerDof;
    diagnostics.planeChi2PerDof = out.planeChi2PerDof;
    diagnostics.numReferences = static_cast<int>(alignment.associations.size());
    diagnostics.msPose = watch.ms();
    alignment.estimate = out;
}

/** Is the estimate to be believed? */
void Aligner::judge(Alignment& alignment, FrameDiagnostics& d) const
{
    const PoseEstimate& estimate = alignment.estimate;
    const PoseGaussian& predicted = alignment.predicted.pose;
    d.observableDirections =
        observableDirections(estimate.infoPoints + estimate.infoPlanes, predicted.cov);
    const int matches = d.numPointPairs + d.numPlanePairs;
    const double sigma = maxSigma(estimate.pose().cov);
    std::ostringstream reason;
    if (matches < minMatches())
    {
        reason << matches << " point and plane matches";
    }
    else if (!fuses_)
    {
        // [P17, section Pose estimation]: the largest eigenvalue, and nothing else.
        alignment.holds = sigma <= params_.gateSigma;
        if (!alignment.holds)
        {
            reason << "largest standard deviation " << sigma << " is above the gate";
        }
    }
    else if (solver_.isWeighted() && d.pointChi2PerDof > params_.maxPointChi2)
    {
        reason << "the points contradict their covariances (chi-square per degree of freedom "
               << d.pointChi2PerDof << ")";
    }
    else if (
        d.numPointPairs + 3 * d.numPlanePairs < kFewPoints &&
        surprise(estimate, predicted) > kMostSurprise)
    {
        reason << "only " << matches << " point and plane matches, far from the predicted motion";
    }
    else if (d.observableDirections == 0)
    {
        reason << "no direction is measured better than it is predicted";
    }
    else
    {
        alignment.holds = true;
        if (d.observableDirections < 6)
        {
            reason << d.observableDirections << " of 6 directions measured, the others predicted";
        }
    }
    alignment.reason = reason.str();
}
}  // namespace pointplane
