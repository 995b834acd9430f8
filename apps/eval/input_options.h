// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>

#include <Eigen/Geometry>

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

/** Numbers from "a,b,c"; none when the text is anything else. */
[[nodiscard]] std::vector<double> numbersFromOption(const std::string& text);

/** Pose from "x,y,z,yaw,pitch,roll" [m, deg], in MRPT's order and convention, or from "optical":
 * optical axes (x right, y down, z forward) in a body with x forward, y left, z up. */
[[nodiscard]] Eigen::Isometry3d poseFromOption(const std::string& text);
}  // namespace pointplane
