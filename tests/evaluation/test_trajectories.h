// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>
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

/** The same trajectory without the poses from begin to end. */
inline Trajectory withHole(Trajectory trajectory, std::size_t begin, std::size_t end)
{
    const auto cut = [&](auto& list)
    {
        const auto first = list.begin();
        list.erase(
            first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end));
    };
    cut(trajectory.stamps);
    cut(trajectory.poses);
    return trajectory;
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

/** Covariance of one frame's increment: 2 mm and 0.1 deg, correlated and unequal. */
inline Matrix6d incrementCov()
{
    Vector6d sigma;
    sigma << 0.002, 0.001, 0.004, 0.002, 0.001, 0.003;
    Matrix6d cov = sigma.cwiseAbs2().asDiagonal();
    cov(0, 4) = cov(4, 0) = 0.5 * sigma[0] * sigma[4];
    return cov;
}

/** Odometry along `truth` whose increments err by N(0, incrementCov()) and which states
 * stated = incrementCov() / optimism^2. */
inline Trajectory odometry(
    const Trajectory& truth,
    unsigned seed,
    double optimism = 1,
    const Vector6d& bias = Vector6d::Zero())
{
    test::GaussianSampler random(seed);
    const Matrix6d cov = incrementCov();
    PoseGaussian pose;
    Trajectory out = truth;
    out.name = "odometry";
    out.poses[0] = pose.mean;
    out.covs = {pose.cov};
    for (std::size_t k = 1; k < truth.size(); ++k)
    {
        const Vector6d error = bias + random.sample(cov);
        const Eigen::Isometry3d step = truth.poses[k - 1].inverse() * truth.poses[k];
        pose = compose(pose, {se3Exp(error) * step, cov / (optimism * optimism)});
        out.poses[k] = pose.mean;
        out.covs.push_back(pose.cov);
    }
    return out;
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
