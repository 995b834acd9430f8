// SPDX-License-Identifier: BSD-3-Clause
#include "Judge.h"

#include <pointplane/core/number_text.h>
#include <pointplane/core/se3.h>
#include <pointplane/core/significance.h>
#include <pointplane/odometry/uncertainty/NoiseScale.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "by_chance.h"

namespace pointplane
{
namespace
{
/** Fewer matches than this in total cannot fix a pose [P17, section Pose estimation]. */
constexpr int kMinMatches = 3;

/** How many directions the measurements know better than the motion model does. */
int observableDirections(const Matrix6d& information, const Matrix6d& priorCovariance)
{
    const Matrix6d L = priorCovariance.llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(L.transpose() * information * L);
    return static_cast<int>((es.eigenvalues().array() > 1).count());
}

/** Root mean square deviation from the predicted pose, in its standard deviations, over the
 * directions in which there may be one: the others are predicted themselves. */
double surprise(
    const Eigen::Isometry3d& T_prev_cur, const PoseGaussian& predicted, int directions = 6)
{
    const Vector6d e = leftError(T_prev_cur, predicted.mean);
    return std::sqrt(e.dot(predicted.cov.ldlt().solve(e)) / directions);
}

double surprise(const Alignment& a)
{
    return surprise(
        a.estimate.motion.mean.T_prev_cur, a.predicted.pose, std::max(1, a.observableDirections));
}

double maxSigma(const Matrix6d& cov)
{
    if (!cov.allFinite())
    {
        return std::numeric_limits<double>::infinity();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(cov);
    return std::sqrt(std::max(0.0, es.eigenvalues().maxCoeff()));
}

/** Fraction of the points in view that agrees with the estimate; smaller if there are few. */
double pointShare(const Alignment& a)
{
    return static_cast<double>(a.estimate.numPointInliers) / std::max(a.numSought, kFewPoints);
}

/** Of the residuals of points; without points, they tell nothing. */
double pointVariance(const Alignment& a)
{
    return a.estimate.numPointInliers > 0 ? a.estimate.pointChi2PerDof
                                          : std::numeric_limits<double>::infinity();
}

/** How much speaks for an alignment, to compare it with another one of the same frame.
 * \param motionVariance residuals of points that are larger are those of no motion, but of one
 * between two */
double evidence(const Alignment& alignment, double motionVariance)
{
    const double surfaces =
        alignment.agreement.fraction() *
        std::min(1.0, 1.0 * alignment.agreement.seen() / Judge::kEnoughSurfaces);
    const bool isMotion = pointVariance(alignment) < motionVariance;
    // Points on what has moved before do not speak for the camera's motion.
    const double points =
        alignment.estimate.pointInlierWorth / std::max(alignment.numSought, kFewPoints);
    return (alignment.holds ? 1 : 0) + (isMotion ? 1 : 0) + surfaces + points;
}

/** Most points in view do not agree on a wrong motion. */
bool mostPointsAgree(const Alignment& a) { return pointShare(a) > 0.5; }

/** Fewer samples may agree by chance, as points may. */
bool showsSurfaces(const Alignment& a) { return a.agreement.seen() >= kFewPoints; }

/** Whether points in view should agree, and no more do than chance may let. */
bool hardlyAnyPointAgrees(const Alignment& a)
{
    return a.numSought >= kFewPoints && a.estimate.numPointInliers < kFewPoints &&
           pointShare(a) < kNoChanceShare;
}

/** Whether it rests on planes that may be others. */
bool isOfDoubtfulPlanes(const Alignment& a)
{
    return hardlyAnyPointAgrees(a) && a.agreement.fraction() <= Judge::kConvincingSurfaces;
}
}  // namespace

Judge::Judge(const OdometryParams& params)
    : params_(params.pipeline),
      fuses_(params.pipeline.fuses()),
      sameDistance_(params.planeMatcher.maxDistance),
      sameAngle_(params.planeMatcher.maxNormalAngleDeg * M_PI / 180)
{
}

/** The paper counts points and planes; with a prediction to fuse with, any of them helps. */
int Judge::minMatches() const { return fuses_ ? 1 : kMinMatches; }

bool Judge::isUncertain(const PoseGaussian& predicted) const
{
    const Vector6d variances = predicted.cov.diagonal();
    return variances.head<3>().maxCoeff() > sameDistance_ * sameDistance_ ||
           variances.tail<3>().maxCoeff() > sameAngle_ * sameAngle_;
}

bool Judge::isConfirmed(const Alignment& a)
{
    return (!a.isPredictionWeak && showsSurfaces(a)) || mostPointsAgree(a);
}

bool Judge::mayBeChance(const Alignment& a) { return !isConfirmed(a) || hardlyAnyPointAgrees(a); }

std::string Judge::fewPointsAgree(const Alignment& alignment)
{
    std::ostringstream out;
    out << "only " << alignment.estimate.numPointInliers << " of " << alignment.numSought
        << " points in view agree with the motion, " << numberText(alignment.predicted.dt, 3)
        << " s after the previous measured frame";
    return out.str();
}

void Judge::keepBetter(Alignment& best, Alignment other, const NoiseFactors& usual)
{
    best.numSought = other.numSought = std::max(best.numSought, other.numSought);
    std::vector<Mark> marks = std::move(best.marks);
    marks.insert(marks.end(), other.marks.begin(), other.marks.end());
    const double motionVariance =
        kConvincingRise *
        std::max(usual.points, std::min(pointVariance(best), pointVariance(other)));
    if (evidence(other, motionVariance) > evidence(best, motionVariance))
    {
        best = std::move(other);
    }
    best.marks = std::move(marks);
}

bool Judge::areSame(const Alignment& a, const Alignment& b)
{
    const PoseGaussian ofA = a.estimate.pose(), ofB = b.estimate.pose();
    return a.holds && b.holds && surprise(ofA.mean, ofB) < 1 && surprise(ofB.mean, ofA) < 1;
}

bool Judge::isConvincing(const Alignment& a, const NoiseFactors& usual)
{
    const int worth =
        a.estimate.numPointInliers + PlanePair::dof() * static_cast<int>(a.problem.planes.size());
    const bool isSeen =
        showsSurfaces(a) ? a.agreement.fraction() > kConvincingSurfaces : mostPointsAgree(a);
    return a.holds && worth >= kFewPoints && (isConfirmed(a) || a.numSought < kFewPoints) &&
           isSeen && a.estimate.pointChi2PerDof < kConvincingRise * usual.points &&
           a.estimate.planeChi2PerDof < kConvincingRise * usual.planes;
}

bool Judge::needsNoOther(const Alignment& a, const NoiseFactors& usual)
{
    return isConvincing(a, usual) && !hardlyAnyPointAgrees(a);
}

bool Judge::areConvincing(const Agreement& surfaces)
{
    return surfaces.seen() >= kEnoughSurfaces && surfaces.fraction() > kConvincingSurfaces;
}

/** Cameras in hands stay below three standard deviations, at any frame rate: the prediction knows
 * how little it knows. Of estimates beyond five, hardly one is right (docs/theory.md, "Verdict").
 */
bool Judge::isSurprising(const Eigen::Isometry3d& T_prev_cur, const PoseGaussian& predicted)
{
    return surprise(T_prev_cur, predicted) > kNoChanceSigmas;
}

bool Judge::isSurprising(const Alignment& alignment)
{
    return surprise(alignment) > kNoChanceSigmas;
}

std::string Judge::whyUnsettled(const Rivalry& rivalry)
{
    return rivalry.isClear() ? ""
                             : "two motions explain about as much surface each: which of them is "
                               "the camera's cannot be told";
}

bool Judge::needsNewView(const Alignment& alignment, const MovingRegions& moving)
{
    return moving.areSure() && alignment.agreement.fraction() < kConvincingSurfaces;
}

void Judge::judge(Alignment& alignment) const
{
    const PoseEstimate& estimate = alignment.estimate;
    const PoseGaussian& predicted = alignment.predicted.pose;
    alignment.observableDirections =
        observableDirections(estimate.infoPoints + estimate.infoPlanes, predicted.cov);
    alignment.isPredictionWeak = isUncertain(predicted);
    const auto matches = static_cast<int>(alignment.numMatches());
    const double sigma = maxSigma(estimate.pose().cov);
    alignment.holds = false;
    std::ostringstream reason;
    if (matches < minMatches())
    {
        reason << "too few points and planes are found again: " << matches;
    }
    else if (!fuses_)
    {
        // [P17, section Pose estimation]: the largest eigenvalue, and nothing else.
        alignment.holds = sigma <= params_.gateSigma;
        if (!alignment.holds)
        {
            reason << "the pose is too uncertain: its largest standard deviation " << sigma
                   << " is above gateSigma";
        }
    }
    else if (alignment.observableDirections == 0)
    {
        reason << "points and planes tell no direction better than the prediction does";
    }
    else
    {
        alignment.holds = true;
        if (alignment.observableDirections < 6)
        {
            reason << "only " << alignment.observableDirections
                   << " of 6 directions are measured, the others are predicted";
        }
    }
    alignment.reason = reason.str();
}

void Judge::contradict(Alignment& alignment, const NoiseFactors& usual) const
{
    if (!alignment.holds || !fuses_)
    {
        return;
    }
    std::ostringstream reason;
    const double agreement = alignment.agreement.fraction();
    if (!alignment.unsettled.empty())
    {
        reason << alignment.unsettled;
    }
    else if (showsSurfaces(alignment) && agreement < params_.leastAgreement)
    {
        reason << "the depth image shows only " << std::lround(100 * agreement)
               << " % of the surfaces where the motion puts them; points and planes it comes from: "
               << alignment.numMatches();
    }
    else if (isSurprising(alignment) && !isConvincing(alignment, usual))
    {
        reason << "the motion is " << std::lround(surprise(alignment))
               << " standard deviations from the predicted one, and too little confirms it: of the "
               << "points in view " << alignment.estimate.numPointInliers << " of "
               << alignment.numSought << ", of the surfaces " << std::lround(100 * agreement)
               << " %";
    }
    else if (alignment.estimate.planeChi2PerDof > NoiseScale::kMostVariance * usual.planes)
    {
        reason << "planes are " << std::lround(std::sqrt(alignment.estimate.planeChi2PerDof))
               << " standard deviations from where the motion puts them";
    }
    else if (isOfDoubtfulPlanes(alignment))
    {
        reason << fewPointsAgree(alignment);
    }
    if (!reason.str().empty())
    {
        alignment.reason = reason.str();
        alignment.holds = false;
    }
}
}  // namespace pointplane
