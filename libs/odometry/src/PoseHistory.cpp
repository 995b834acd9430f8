// SPDX-License-Identifier: BSD-3-Clause
#include "PoseHistory.h"

#include <pointplane/core/covariance.h>

#include <algorithm>

namespace pointplane
{
PoseHistory::PoseHistory(int history) : joint_(history), poses_{Eigen::Isometry3d::Identity()}
{
    joint_.start(0, Matrix6d::Zero());
}

void PoseHistory::predict(const PoseGaussian& increment)
{
    JointCovariance::Prediction errors;
    errors.noise.topLeftCorner<6, 6>() = increment.cov;
    predict(increment.mean, errors);
    joint_.endCoasting();
}

void PoseHistory::predict(
    const Eigen::Isometry3d& T_latest_cur, const JointCovariance::Prediction& errors)
{
    joint_.predict(poses_.front(), errors);
    poses_.push_front(poses_.front() * T_latest_cur);
}

void PoseHistory::measure(
    const Eigen::Isometry3d& T_world_prev,
    const Eigen::Isometry3d& T_prev_cur,
    const DecayedVelocities& decayed,
    const JointCovariance::Measurement& errors,
    const std::optional<MotionModel::Smoothed>& previousVelocity)
{
    joint_.measure(T_world_prev, decayed, errors, previousVelocity);
    poses_.push_front(T_world_prev * T_prev_cur);
}

void PoseHistory::keep(const std::vector<int>& references, const std::vector<int>& poses)
{
    joint_.keep(references, poses);
    poses_.resize(std::min(poses_.size(), static_cast<size_t>(joint_.history()) + 1));
}

PoseGaussian PoseHistory::pose() const
{
    return {poses_.front(), strictlyPositive(joint_.latest())};
}

PoseGaussian PoseHistory::since(int framesAgo) const
{
    const Eigen::Isometry3d& T_world_past = poses_[static_cast<size_t>(framesAgo)];
    const Matrix6d cov = joint_.relative(latestFrame() - framesAgo, T_world_past);
    return {T_world_past.inverse() * poses_.front(), strictlyPositive(cov)};
}

std::vector<PoseGaussian> PoseHistory::sinceAll() const
{
    std::vector<PoseGaussian> out;
    for (int n = 1; n <= joint_.history() && n < latestFrame(); ++n)
    {
        out.push_back(since(n));
    }
    return out;
}
}  // namespace pointplane
