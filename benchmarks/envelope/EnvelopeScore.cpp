// SPDX-License-Identifier: BSD-3-Clause
#include "EnvelopeScore.h"

#include <pointplane/core/covariance.h>
#include <pointplane/core/quantile.h>
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/stamp_intervals.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr double kSigmas = 5;
constexpr double kLeastTranslation = 0.010, kLeastRotation = 1.0 * M_PI / 180;
constexpr double kLargeTranslation = 0.050, kLargeRotation = 5.0 * M_PI / 180;

[[nodiscard]] bool isBeyond(const Eigen::Vector3d& error, const Eigen::Matrix3d& cov, double least)
{
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> es(cov);
    const Eigen::Array3d along = (es.eigenvectors().transpose() * error).array().abs();
    const Eigen::Array3d sigma = es.eigenvalues().array().max(0).sqrt();
    return (along > kSigmas * sigma && along > least).any();
}

[[nodiscard]] double largestSigma(const Eigen::Matrix3d& cov)
{
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> es(cov, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, es.eigenvalues().maxCoeff()));
}

/** Noise of the ground truth at both ends of a motion. */
[[nodiscard]] Matrix6d truthNoise(const NeesOptions& options, const Eigen::Isometry3d& motion)
{
    Vector6d variances;
    variances.head<3>().setConstant(std::pow(options.truthSigmaTranslation, 2));
    variances.tail<3>() = options.truthSigmaRotation.cwiseAbs2();
    const Matrix6d N = variances.asDiagonal();
    return N + propagate(adjoint(motion), N);
}

}  // namespace

bool isBeyondFiveSigma(const Vector6d& error, const Matrix6d& cov)
{
    return isBeyond(error.head<3>(), cov.topLeftCorner<3, 3>(), kLeastTranslation) ||
           isBeyond(error.tail<3>(), cov.bottomRightCorner<3, 3>(), kLeastRotation);
}

void EnvelopeScorer::addStep(
    const MethodStep& step, const Eigen::Isometry3d& truth, ScoredStep scored)
{
    const Vector6d error = se3Log(truth * step.T_prev_cur.inverse());
    scored.errorTranslation = error.head<3>().norm();
    scored.errorRotation = error.tail<3>().norm();
    if (step.incrementCov)
    {
        const Matrix6d cov = *step.incrementCov + truthNoise(sequence_.nees, truth);
        scored.sigmaTranslation = largestSigma(cov.topLeftCorner<3, 3>());
        scored.sigmaRotation = largestSigma(cov.bottomRightCorner<3, 3>());
        if (sequence_.kind == Truth::Exact)
        {
            // What is no covariance cannot allow for any error.
            const bool isCov = isPositiveDefinite(cov);
            scored.nees = isCov ? error.dot(cov.ldlt().solve(error)) / 6 : 0;
            scored.isBeyond = !isCov || isBeyondFiveSigma(error, cov);
        }
    }
    tracked_.push_back(scored);
}

void EnvelopeScorer::addPairs(
    const std::vector<double>& stamps,
    const std::vector<Eigen::Isometry3d>& poses,
    const SampledTruth& truth)
{
    constexpr double kDelta = 1.0, kMaxTolerance = 0.2;  // [s]
    const double tolerance = std::min(kMaxTolerance, 0.5 * medianInterval(stamps) + 1e-6);
    for (std::size_t i = 0; i < stamps.size(); ++i)
    {
        const std::size_t j = nearestIndex(stamps, stamps[i] + kDelta);
        if (j <= i || std::abs(stamps[j] - stamps[i] - kDelta) > tolerance || truth.valid[i] == 0 ||
            truth.valid[j] == 0)
        {
            continue;
        }
        const Eigen::Isometry3d error =
            (truth.poses[i].inverse() * truth.poses[j]).inverse() * poses[i].inverse() * poses[j];
        sumTranslation_ += error.translation().squaredNorm();
        sumRotation_ += std::pow(rotationAngle(error.linear()), 2);
        ++numPairs_;
    }
}

void EnvelopeScorer::add(const std::vector<double>& stamps, const std::vector<MethodStep>& steps)
{
    const bool hasTruth = sequence_.kind != Truth::None;
    SampledTruth truth;
    if (hasTruth)
    {
        truth = sampleTruth(sequence_.truth, stamps, 0, TruthAt::Interpolated);
    }
    std::vector<Eigen::Isometry3d> poses;
    for (std::size_t k = 0; k < steps.size(); ++k)
    {
        poses.push_back(k == 0 ? steps[k].T_prev_cur : poses.back() * steps[k].T_prev_cur);
        if (k == 0)
        {
            continue;
        }
        ++numSteps_;
        if (steps[k].outcome != Outcome::Measured)
        {
            continue;
        }
        ++numTracked_;
        const ScoredStep scored{numRuns_, k, stamps[k]};
        if (!hasTruth)
        {
            addStep(steps[k], Eigen::Isometry3d::Identity(), scored);
        }
        else if (truth.valid[k - 1] != 0 && truth.valid[k] != 0)
        {
            addStep(steps[k], truth.poses[k - 1].inverse() * truth.poses[k], scored);
        }
    }
    if (hasTruth)
    {
        addPairs(stamps, poses, truth);
    }
    ++numRuns_;
}

EnvelopeScore EnvelopeScorer::score(EnvelopeScore score) const
{
    score.truth = sequence_.kind;
    score.numSteps = numSteps_;
    score.numTracked = numTracked_;
    score.numPairs = numPairs_;
    if (numPairs_ > 0)
    {
        score.rpeTranslation = std::sqrt(sumTranslation_ / static_cast<double>(numPairs_));
        score.rpeRotation = std::sqrt(sumRotation_ / static_cast<double>(numPairs_));
    }
    std::vector<double> nees;
    for (const ScoredStep& step : tracked_)
    {
        score.worstTranslation = std::max(score.worstTranslation, step.errorTranslation);
        score.worstRotation = std::max(score.worstRotation, step.errorRotation);
        score.largestSigma = std::max(score.largestSigma, step.sigmaTranslation);
        if (step.nees > 0)
        {
            nees.push_back(step.nees);
        }
        if (step.isBeyond)
        {
            score.beyond.push_back(step);
        }
        if (step.errorTranslation > kLargeTranslation || step.errorRotation > kLargeRotation)
        {
            score.large.push_back(step);
        }
    }
    if (!nees.empty())
    {
        score.neesMedian = median(nees);
        score.nees99 = quantile(nees, 0.99);
    }
    return score;
}
}  // namespace pointplane
