// SPDX-License-Identifier: BSD-3-Clause
#include "MethodRun.h"

#include <pointplane/core/quantile.h>
#include <pointplane/evaluation/ate.h>
#include <pointplane/evaluation/consistency.h>
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/rpe.h>
#include <pointplane/mrpt_io/errors.h>

#include <chrono>

namespace pointplane
{
namespace
{
[[nodiscard]] std::optional<double> neesPerDof(
    const BenchmarkSequence& sequence, const Trajectory& estimate, const char* name)
{
    if (estimate.covs.empty() || sequence.kind != Truth::Exact)
    {
        return std::nullopt;
    }
    const NeesInterval interval = neesIntervalFromName(name);
    try
    {
        const auto increments = neesIncrements(sequence.truth, estimate, interval, sequence.nees);
        return consistencyOf(increments, countIndependent(increments), interval).joint.nees;
    }
    catch (const std::runtime_error&)
    {
        return std::nullopt;  // fewer increments than it takes
    }
}
}  // namespace

MethodRun::MethodRun(const NamedMethod& method) : method_(method.create())
{
    score_.method = method.name;
    score_.isPeer = method.isPeer;
    estimate_.name = method.name;
}

void MethodRun::process(const RgbdFrame& frame)
{
    if (!score_.failure.empty())
    {
        return;
    }
    try
    {
        const auto start = std::chrono::steady_clock::now();
        const MethodStep step = method_->process(frame);
        ms_.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count());
        pose_ = pose_ * step.T_prev_cur;
        score_.numLost += step.outcome == Outcome::Lost ? 1 : 0;
        score_.numPredicted += step.outcome == Outcome::Predicted ? 1 : 0;
        estimate_.stamps.push_back(frame.stamp);
        estimate_.poses.push_back(step.pose ? step.pose->mean : pose_);
        if (step.pose)
        {
            estimate_.covs.push_back(step.pose->cov);
            std::vector<Matrix6d>& since = estimate_.sinceCovs.emplace_back();
            for (const PoseGaussian& motion : step.since)
            {
                since.push_back(motion.cov);
            }
        }
    }
    catch (const std::exception& error)
    {
        // One method that gives up must not take the others' results with it.
        score_.failure = oneLine(error);
    }
}

MethodScore MethodRun::score(const BenchmarkSequence& sequence) const
{
    MethodScore out = score_;
    out.numFrames = static_cast<int>(ms_.size());
    if (!out.failure.empty())
    {
        return out;
    }
    RpeOptions options;
    options.fixedDelta = true;
    const RpeResult rpe = relativePoseError(sequence.truth, estimate_, options);
    out.rpeTranslation = rpe.translation.rmse;
    out.rpeRotation = rpe.rotation.rmse;
    out.ate = absoluteTrajectoryError(sequence.truth, estimate_, {}).translation.rmse;
    out.msMedian = median(ms_);
    out.msP99 = quantile(ms_, 0.99);
    if (sequence.kind == Truth::Exact)  // another odometry's truth cannot judge covariances
    {
        out.nees = {
            neesPerDof(sequence, estimate_, "1f"),
            neesPerDof(sequence, estimate_, "10f"),
            neesPerDof(sequence, estimate_, "1s")};
    }
    return out;
}
}  // namespace pointplane
