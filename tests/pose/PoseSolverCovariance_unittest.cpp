// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/chi_square.h>
#include <pointplane/pose/PoseSolver.h>

#include <functional>
#include <optional>
#include <vector>

#include "synthetic_pairs.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kRuns = 600;

/** What so many runs say of the covariance that each claims. */
struct Consistency
{
    double nees{0};             //!< mean e^T cov^-1 e, of 6
    double chi2{0};             //!< of the points, per degree of freedom
    double shapeDifference{0};  //!< Frobenius norm of the whitened sample covariance minus I
};

Consistency consistency(
    test::PairWorld& world,
    const PoseSolver::TParams& params,
    const std::optional<Matrix6d>& priorCov = std::nullopt,
    double noiseScale = 1,
    const NoiseFactors& noise = {},
    const std::function<void(std::vector<PointPair>&)>& change = {})
{
    const PoseSolver solver(params);
    Consistency out;
    std::vector<Vector6d> errors;
    Matrix6d meanCov = Matrix6d::Zero();
    for (int i = 0; i < kRuns; ++i)
    {
        MotionPrior prior = MotionPrior::fixedVelocity({});
        if (priorCov)
        {
            // truth = exp(xi) * mean
            const Vector6d xi = world.sampler().sample(*priorCov);
            prior.mean.T_prev_cur = se3Exp(-xi) * world.T_prev_cur;
            prior.pose = test::inverse(*priorCov);
        }
        PoseProblem problem{
            world.drawPoints(noiseScale), world.drawPlanes(noiseScale), prior, noise};
        if (change)
        {
            change(problem.points);
        }
        const PoseEstimate e = solver.solve(problem, prior.mean);
        out.chi2 += e.pointChi2PerDof / kRuns;
        errors.push_back(leftError(world.T_prev_cur, e.pose().mean));
        out.nees += test::squaredMahalanobis(errors.back(), e.pose().cov) / kRuns;
        meanCov += e.pose().cov / kRuns;
    }
    out.shapeDifference = test::whitenedDifference(test::sampleCovariance(errors), meanCov);
    return out;
}

/** Within the two-sided 99.9 % interval of chi^2(6 n) / n, on either side. */
void expectConsistent(const Consistency& c)
{
    EXPECT_GT(c.nees, chiSquareQuantile(0.0005, 6.0 * kRuns) / kRuns);
    EXPECT_LT(c.nees, chiSquareQuantile(0.9995, 6.0 * kRuns) / kRuns);
    EXPECT_LT(c.shapeDifference, 0.42);  // sqrt(42 / 600) = 0.26 for a right covariance
}

/** Which features a world has; every world moves by 3 cm and 2 degrees. */
test::PairWorld makeWorld(unsigned seed, int points, int planes)
{
    test::PairWorld world(seed);
    world.addPoints(points);
    world.addPlanes(planes);
    world.T_prev_cur = world.randomMotion(0.03, 0.035);
    return world;
}
}  // namespace

TEST(PoseSolverCovariance, ofPoints)
{
    auto world = makeWorld(31, 40, 0);
    expectConsistent(consistency(world, test::gaussianSolver()));
}

/** Half of the points have no depth in the current frame. It is guessed, 10 % wrong. */
TEST(PoseSolverCovariance, ofPointsWithoutDepth)
{
    auto world = makeWorld(39, 40, 0);
    const auto forgetDepth = [&](std::vector<PointPair>& points)
    {
        for (size_t i = 0; i < points.size(); i += 2)
        {
            PointGaussian& cur = points[i].cur;
            const double guess = world.sampler().uniform(0.9, 1.1);
            cur.mean *= guess;
            cur.cov = guess * guess * cur.cov + cur.mean * cur.mean.transpose();
            points[i].hasDepth = false;
        }
    };
    const Consistency c =
        consistency(world, test::gaussianSolver(), std::nullopt, 1, {}, forgetDepth);
    expectConsistent(c);
    // 100 residuals of 40 points tell 6 parameters.
    EXPECT_NEAR(c.chi2, 94.0 / 100, 0.03);
}

TEST(PoseSolverCovariance, ofPlanes)
{
    auto world = makeWorld(32, 0, 5);
    expectConsistent(consistency(world, test::gaussianSolver()));
    PoseSolver::TParams params = test::gaussianSolver();
    params.planeResidual = "closestPoint";
    expectConsistent(consistency(world, params));
}

TEST(PoseSolverCovariance, ofPointsAndPlanes)
{
    auto world = makeWorld(33, 25, 4);
    expectConsistent(consistency(world, test::gaussianSolver()));
}

TEST(PoseSolverCovariance, withPrior)
{
    auto world = makeWorld(34, 10, 2);
    const Matrix6d cov = world.sampler().covariance<6>(1e-6, 2e-5);
    expectConsistent(consistency(world, test::gaussianSolver(), cov));
}

/** One wall and the prior: half of the directions come from either. */
TEST(PoseSolverCovariance, degenerateWithPrior)
{
    auto world = makeWorld(35, 0, 1);
    const Matrix6d cov = 1e-4 * Matrix6d::Identity();
    expectConsistent(consistency(world, test::gaussianSolver(), cov));
}

/** Weights that are not the inverse covariance: the sandwich H^-1 M H^-1 accounts for them. */
TEST(PoseSolverCovariance, ofSuboptimalWeights)
{
    for (const char* weighting : {"diagonal", "none"})
    {
        SCOPED_TRACE(weighting);
        auto world = makeWorld(36, 25, 4);
        PoseSolver::TParams params = test::gaussianSolver();
        params.weighting = weighting;
        params.planeResidual = "closestPoint";
        params.alpha = 10;
        expectConsistent(consistency(world, params));
    }
}

/** The paper's: H = J^T W J of all weighted residuals, alpha with them. */
TEST(PoseSolverCovariance, hessianIsTheInverseOfTheInformation)
{
    auto world = makeWorld(39, 25, 4);
    PoseSolver::TParams params = test::gaussianSolver();
    params.weighting = "diagonal";
    params.planeResidual = "closestPoint";
    params.alpha = 10;
    params.covariance = "hessian";
    PoseProblem problem{world.drawPoints(), world.drawPlanes(), MotionPrior::fixedVelocity({}), {}};
    const PoseEstimate e = PoseSolver(params).solve(problem, {});
    const Matrix6d H = e.infoPoints + 10 * e.infoPlanes;
    EXPECT_LT(test::whitenedDifference(e.pose().cov, test::inverse(H)), 1e-5);
    params.covariance = "sandwich";
    EXPECT_GT(
        test::whitenedDifference(
            PoseSolver(params).solve(problem, {}).pose().cov, test::inverse(H)),
        0.1);
}

TEST(PoseSolverCovariance, ofCorrelatedNoiseByItsFactor)
{
    auto world = makeWorld(37, 25, 4);
    const Matrix6d cov = world.sampler().covariance<6>(1e-6, 2e-5);
    expectConsistent(consistency(world, test::gaussianSolver(), cov, 3, {9, 9}));
}

/** Down-weighting what is far out by chance costs efficiency, which the covariance must admit. */
TEST(PoseSolverCovariance, ofTukeysWeights)
{
    auto world = makeWorld(38, 60, 0);
    PoseSolver::TParams params = test::gaussianSolver();
    params.tukeySigmas = PoseSolver::TParams{}.tukeySigmas;
    expectConsistent(consistency(world, params));
}

TEST(PoseSolverCovariance, ofStudentsWeights)
{
    auto world = makeWorld(39, 0, 12);
    PoseSolver::TParams params = test::gaussianSolver();
    params.planeStudentDof = PoseSolver::TParams{}.planeStudentDof;
    expectConsistent(consistency(world, params));
}

/** A rolling shutter tells the velocity, and what it leaves of it makes the pose uncertain. */
TEST(PoseSolverCovariance, ofPoseAndVelocityTogether)
{
    auto world = makeWorld(39, 40, 3);
    MotionGaussian predicted;
    predicted.cov.diagonal() << Vector6d::Constant(1e-4), Vector6d::Constant(0.01);
    predicted.cov.topRightCorner<6, 6>() = predicted.cov.bottomLeftCorner<6, 6>() =
        5e-4 * Matrix6d::Identity();
    const PoseSolver solver(test::gaussianSolver());
    Consistency c;
    double velocityNees = 0, velocityGain = 0;
    for (int i = 0; i < kRuns; ++i)
    {
        const Vector12d deviation = world.sampler().sample(predicted.cov);
        predicted.mean.T_prev_cur = se3Exp(-deviation.head<6>()) * world.T_prev_cur;
        const Vector6d velocity = predicted.mean.velocity + deviation.tail<6>();
        auto points = world.drawPoints();
        for (size_t k = 0; k < points.size(); ++k)
        {
            // Rows from top to bottom are exposed within 30 ms.
            const double s =
                0.03 * (static_cast<double>(k) / static_cast<double>(points.size()) - 0.5);
            Matrix36d D;
            D << s * Eigen::Matrix3d::Identity(), -s * hat(points[k].cur.mean);
            points[k].dCur_dV = D;
            points[k].cur.mean -= D * velocity;
        }
        const PoseEstimate e = solver.solve(
            {points, world.drawPlanes(), MotionPrior::from(predicted), {}}, predicted.mean);
        Vector12d error;
        error << leftError(world.T_prev_cur, e.pose().mean), velocity - e.motion.mean.velocity;
        c.nees += test::squaredMahalanobis(error, e.motion.cov) / kRuns;
        velocityNees +=
            test::squaredMahalanobis(error.tail<6>(), e.motion.cov.bottomRightCorner<6, 6>()) /
            kRuns;
        velocityGain += e.motion.cov(6, 6) / predicted.cov(6, 6) / kRuns;
    }
    EXPECT_NEAR(c.nees / 12, 1, 0.08);
    EXPECT_NEAR(velocityNees / 6, 1, 0.12);
    EXPECT_LT(velocityGain, 0.7);
}
}  // namespace pointplane
