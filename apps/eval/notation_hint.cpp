// SPDX-License-Identifier: BSD-3-Clause
#include "notation_hint.h"

#include <pointplane/evaluation/rpe.h>

#include <stdexcept>

namespace pointplane
{
namespace
{
Trajectory scaled(Trajectory trajectory, double factor)
{
    for (Eigen::Isometry3d& pose : trajectory.poses)
    {
        pose.translation() *= factor;
    }
    return trajectory;
}

/** As if the first of the four numbers were w. */
Trajectory reordered(Trajectory trajectory)
{
    for (Eigen::Isometry3d& pose : trajectory.poses)
    {
        const Eigen::Quaterniond q(pose.linear());
        pose.linear() = Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()).toRotationMatrix();
    }
    return trajectory;
}

/** How motions between any two poses differ. */
RpeResult difference(const Trajectory& truth, const Trajectory& estimate, double offset)
{
    RpeOptions options;
    options.offset = offset;
    options.maxPairs = 10000;
    return relativePoseError(truth, estimate, options);
}

/** Whether the translations are. \return false if the ground truth stands still */
bool areAlike(const Trajectory& truth, const Trajectory& estimate, double offset)
{
    constexpr double kAlike = 0.3;  // of the motion: also of a poor odometry
    const double motion = difference(truth, scaled(estimate, 0), offset).translation.rmse;
    return difference(truth, estimate, offset).translation.rmse < kAlike * motion;
}

std::string hintAtOrder(const Trajectory& truth, const Trajectory& estimate, double offset)
{
    constexpr double kBetter = 0.2;
    const double most = kBetter * difference(truth, estimate, offset).rotation.rmse;
    // Rotations about one axis are alike in other axes, too; translations then are not.
    const auto fit = [&](const Trajectory& a, const Trajectory& b)
    { return difference(a, b, offset).rotation.rmse < most && areAlike(a, b, offset); };
    const bool ofTruth = fit(reordered(truth), estimate);
    const bool ofEstimate = fit(truth, reordered(estimate));
    return ofTruth == ofEstimate ? ""
                                 : "quaternions of '" + (ofTruth ? truth : estimate).name +
                                       "' look like qw qx qy qz: write them as qx qy qz qw";
}

std::string hintAtUnit(const Trajectory& truth, const Trajectory& estimate, double offset)
{
    constexpr double kPerMillimetre = 1e-3;
    const bool ofTruth = areAlike(scaled(truth, kPerMillimetre), estimate, offset);
    return ofTruth || areAlike(truth, scaled(estimate, kPerMillimetre), offset)
               ? "positions of '" + (ofTruth ? truth : estimate).name +
                     "' look like millimetres: write them in metres"
               : "";
}
}  // namespace

std::string hintAtNotation(
    const Trajectory& truth, const Trajectory& estimate, double offset, double scale)
{
    try
    {
        const Trajectory measured = scaled(estimate, scale);
        const std::string hint = hintAtOrder(truth, measured, offset);
        // Who scales knows the units.
        return hint.empty() && scale == 1 ? hintAtUnit(truth, measured, offset) : hint;
    }
    catch (const std::runtime_error&)  // too few pairs tell nothing
    {
        return "";
    }
}
}  // namespace pointplane
