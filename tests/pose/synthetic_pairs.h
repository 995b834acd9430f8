// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/se3.h>
#include <pointplane/pose/PoseSolver.h>
#include <pointplane/pose/pairs.h>
#include <pointplane/pose/residuals.h>

#include <optional>
#include <vector>

#include "linear_algebra.h"
#include "monte_carlo.h"

namespace pointplane::test
{
/** A solver for pairs without outliers, whose errors are those of the pairs alone. */
inline PoseSolver::TParams gaussianSolver()
{
    PoseSolver::TParams params;
    params.tukeySigmas = 0;
    params.planeStudentDof = 0;
    params.priorStudentDof = 0;
    return params;
}

/** The pose alone, pairs taken at rest. \param prior what is known of it without the pairs */
inline PoseProblem atRest(
    const std::vector<PointPair>& points,
    const std::vector<PlanePair>& planes,
    const Eigen::Isometry3d& start = Eigen::Isometry3d::Identity(),
    const std::optional<PoseGaussian>& prior = std::nullopt)
{
    PoseProblem out{points, planes, MotionPrior::fixedVelocity({start, Vector6d::Zero()}), {}};
    if (prior)
    {
        out.prior.mean.T_prev_cur = prior->mean;
        out.prior.pose = inverse(prior->cov);
    }
    return out;
}

/** True points and planes in the previous frame, each with the covariances that a Kinect's features
 * have; pairs are drawn from them. */
class PairWorld
{
 public:
    explicit PairWorld(unsigned seed) : sampler_(seed) {}

    Eigen::Isometry3d T_prev_cur{Eigen::Isometry3d::Identity()};  //!< truth

    void addPoint(const Eigen::Vector3d& p_prev)
    {
        points_.push_back({p_prev, kinectCovariance(p_prev), kinectCovariance(p_prev)});
    }

    /** Points in a camera's view, 1 to 4 m away. */
    void addPoints(int n)
    {
        for (int i = 0; i < n; ++i)
        {
            const double z = sampler_.uniform(1, 4);
            addPoint({z * sampler_.uniform(-0.6, 0.6), z * sampler_.uniform(-0.45, 0.45), z});
        }
    }

    void addPlane(const Eigen::Vector3d& n, double d)
    {
        planes_.push_back(
            {n.normalized() / d,
             sampler_.covariance<3>(0.2e-6, 2e-6),
             sampler_.covariance<3>(0.2e-6, 2e-6)});
    }

    /** Planes at 1 to 3 m with normals towards the camera. */
    void addPlanes(int n)
    {
        for (int i = 0; i < n; ++i)
        {
            // One after the other: compilers differ in the order of arguments.
            const double d = sampler_.uniform(1, 3);
            const double y = sampler_.uniform(-1, 1);
            const double x = sampler_.uniform(-1, 1);
            addPlane({x, y, -1}, d);
        }
    }

    /** \param scale of the noise's sigma; 0 = exact */
    [[nodiscard]] std::vector<PointPair> drawPoints(double scale = 1)
    {
        std::vector<PointPair> out;
        for (const Point& p : points_)
        {
            out.push_back(
                {{p.mean + scale * sampler_.sample(p.covBase), p.covBase},
                 {T_prev_cur.inverse() * p.mean + scale * sampler_.sample(p.covCur), p.covCur}});
        }
        return out;
    }

    [[nodiscard]] std::vector<PlanePair> drawPlanes(double scale = 1)
    {
        std::vector<PlanePair> out;
        for (const PlaneTruth& p : planes_)
        {
            const PlaneGaussian inCur =
                transformed(T_prev_cur.inverse(), PlaneGaussian{p.theta, {}});
            out.push_back(
                {{p.theta + scale * sampler_.sample(p.covBase), p.covBase},
                 {inCur.theta_m + scale * sampler_.sample(p.covCur), p.covCur}});
        }
        return out;
    }

    [[nodiscard]] GaussianSampler& sampler() { return sampler_; }

    /** A motion of exactly so many metres and radians in a random direction. */
    [[nodiscard]] Eigen::Isometry3d randomMotion(double metres, double radians)
    {
        Vector6d xi;
        xi << metres * sampler_.vector<3>().normalized(),
            radians * sampler_.vector<3>().normalized();
        return se3Exp(xi);
    }

 private:
    struct Point
    {
        Eigen::Vector3d mean;
        Eigen::Matrix3d covBase, covCur;
    };
    struct PlaneTruth
    {
        Eigen::Vector3d theta;
        Eigen::Matrix3d covBase, covCur;
    };

    /** Half a pixel at f = 525, and Khoshelham's sigma_Z. */
    static Eigen::Matrix3d kinectCovariance(const Eigen::Vector3d& p)
    {
        const double lateral = 0.5 / 525 * p.z(), axial = 1.425e-3 * p.z();
        Eigen::Matrix3d cov = axial * axial * p * p.transpose();
        cov.diagonal().head<2>().array() += lateral * lateral;
        return cov;
    }

    GaussianSampler sampler_;
    std::vector<Point> points_;
    std::vector<PlaneTruth> planes_;
};

/** So many points and planes, seen after a motion of 3 cm and 2 deg. */
inline PairWorld moved(unsigned seed, int numPoints, int numPlanes)
{
    PairWorld out(seed);
    out.addPoints(numPoints);
    out.addPlanes(numPlanes);
    out.T_prev_cur = out.randomMotion(0.03, 0.035);
    return out;
}
}  // namespace pointplane::test
