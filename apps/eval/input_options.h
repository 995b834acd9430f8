// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>
#include <pointplane/evaluation/rpe.h>

#include <Eigen/Geometry>

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pointplane
{
struct CommandContext;

/** Options that say how trajectories are read; all commands share them. */
struct InputOptions
{
    std::string bodyFromTruth;  //!< "", "optical" or "x,y,z,yaw,pitch,roll" [m, deg]
    std::string sensorLabel;    //!< of the poses in a rawlog; empty: the only one there is

    void addTo(CLI::App& command);

    /** The estimate's body in the ground truth's body frame; throws std::invalid_argument. */
    [[nodiscard]] Eigen::Isometry3d T_truth_body() const;

    /** Ground truth as its file gives it. Prints the reader's warnings. */
    [[nodiscard]] Trajectory loadTruth(const std::string& path, CommandContext& context) const;
    /** Ground truth of the estimate's body. */
    [[nodiscard]] Trajectory loadTruthOfBody(
        const std::string& path, CommandContext& context) const;
    [[nodiscard]] Trajectory loadEstimate(const std::string& path, CommandContext& context) const;
};

/** Warns if both are one file: its errors are zero, and pass any limit. Warns if the ground truth
 * is what an odometry writes (with marks of frames, or covariances) and the estimate is not: they
 * may be in the wrong order. */
void checkOrder(const Trajectory& truth, const Trajectory& estimate, CommandContext& context);

/** Warns if the ground truth is too sparse to be taken at the estimate's stamps. */
void checkTruthRate(const Trajectory& truth, const Trajectory& estimate, CommandContext& context);

/** \return a hint for the user if the files tell that their poses are of different bodies, which
 * --body-from-gt does not bring together: errors then look like those of a bad odometry */
[[nodiscard]] std::string hintAtBodies(
    const InputOptions& input, const Trajectory& truth, const Trajectory& estimate);

/** hintAtBodies(). If the truth does not tell: poses of MRPT's files are of the robot, and TUM
 * ground truth is usually of the camera.
 * \param scoreWith the score (the less the better) with another body of the ground truth
 * \return also a hint if the optical one makes the score less than `share` of what it is */
[[nodiscard]] std::string hintAtAxes(
    const InputOptions& input,
    const Trajectory& truth,
    const Trajectory& estimate,
    double score,
    double share,
    const std::string& name,
    const std::function<double(const Eigen::Isometry3d& T_truth_body)>& scoreWith);

/** The same by the RPE's translation. */
[[nodiscard]] std::string hintAtAxes(
    const InputOptions& input,
    const Trajectory& truth,
    const Trajectory& estimate,
    const RpeResult& result,
    const RpeOptions& options);

/** Numbers from "a,b,c"; none when the text is anything else. */
[[nodiscard]] std::vector<double> numbersFromOption(const std::string& text);
}  // namespace pointplane
