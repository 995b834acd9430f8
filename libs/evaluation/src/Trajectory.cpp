// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/Trajectory.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** Running sum of measure(T_next_previous), starting at 0. */
template <class Measure>
std::vector<double> accumulate(const Trajectory& trajectory, Measure measure)
{
    std::vector<double> out;
    for (std::size_t i = 0; i < trajectory.size(); ++i)
    {
        out.push_back(
            i == 0 ? 0
                   : out.back() + measure(trajectory.poses[i].inverse() * trajectory.poses[i - 1]));
    }
    return out;
}

/** Of a list with one entry per pose (or of an empty one), those to keep. */
template <class T>
void keep(const std::vector<bool>& kept, std::vector<T>& list)
{
    std::size_t num = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
    {
        if (kept[i])
        {
            list[num++] = list[i];
        }
    }
    list.resize(num);
}
}  // namespace

std::vector<double> pathLengths(const Trajectory& trajectory)
{
    return accumulate(
        trajectory, [](const Eigen::Isometry3d& T) { return T.translation().norm(); });
}

std::vector<double> accumulatedAngles(const Trajectory& trajectory)
{
    return accumulate(
        trajectory, [](const Eigen::Isometry3d& T) { return rotationAngle(T.linear()); });
}

double rotationAngle(const Eigen::Matrix3d& R)
{
    return std::acos(std::clamp((R.trace() - 1) / 2, -1.0, 1.0));
}

Trajectory withoutLost(Trajectory trajectory)
{
    std::vector<bool> measured;
    for (const FrameStatus status : trajectory.status)
    {
        measured.push_back(status != FrameStatus::Lost);
        if (!measured.back())
        {
            trajectory.lostStamps.push_back(trajectory.stamps[measured.size() - 1]);
        }
    }
    if (std::find(measured.begin(), measured.end(), false) == measured.end())
    {
        return trajectory;
    }
    std::sort(trajectory.lostStamps.begin(), trajectory.lostStamps.end());
    keep(measured, trajectory.stamps);
    keep(measured, trajectory.poses);
    keep(measured, trajectory.covs);
    keep(measured, trajectory.status);
    trajectory.sinceCovs.clear();
    trajectory.numbers.clear();
    return trajectory;
}

Trajectory withBody(Trajectory trajectory, const Eigen::Isometry3d& T_body_other)
{
    for (Eigen::Isometry3d& pose : trajectory.poses)
    {
        pose = pose * T_body_other;
    }
    const Matrix6d Ad = adjoint(T_body_other.inverse());
    for (std::vector<Matrix6d>& covs : trajectory.sinceCovs)
    {
        for (Matrix6d& cov : covs)
        {
            cov = propagate(Ad, cov);
        }
    }
    return trajectory;
}
}  // namespace pointplane
