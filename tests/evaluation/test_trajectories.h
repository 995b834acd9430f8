// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/se3.h>
#include <pointplane/evaluation/Trajectory.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "TempDir.h"
#include "monte_carlo.h"

namespace pointplane
{
/** A smooth random walk: n poses, one per `interval` seconds. */
inline Trajectory randomTrajectory(std::size_t n, unsigned seed, double interval = 0.1)
{
    test::GaussianSampler random(seed);
    std::vector<StampedPose> poses;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (std::size_t i = 0; i < n; ++i)
    {
        poses.push_back({100 + interval * static_cast<double>(i), T, {}});
        T = orthonormalised(T * se3Exp(0.05 * random.vector<6>()));
    }
    return makeTrajectory("random", poses);
}

/** The same trajectory with every pose perturbed on the left by N(0, sigma^2). */
inline Trajectory perturbed(Trajectory trajectory, double sigma, unsigned seed)
{
    test::GaussianSampler random(seed);
    for (Eigen::Isometry3d& T : trajectory.poses)
    {
        T = orthonormalised(se3Exp(sigma * random.vector<6>()) * T);
    }
    return trajectory;
}

/** Writes a text file into `dir` and returns its path. */
inline std::string writeFile(
    const test::TempDir& dir, const std::string& name, const std::string& text)
{
    std::ofstream(dir / name) << text;
    return dir / name;
}

/** $POINTPLANE_DATA/evaluate_rpe_golden, or empty. */
inline std::string goldenDirectory()
{
    const char* data = std::getenv("POINTPLANE_DATA");
    return data == nullptr ? "" : std::string(data) + "/evaluate_rpe_golden";
}
}  // namespace pointplane
