// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/pose/PoseSolver.h>
#include <pointplane/pose/median_variance.h>
#include <pointplane/pose/residuals.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "matchers.h"
#include "synthetic_pairs.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::PairWorld;

const Eigen::Isometry3d kStart = Eigen::Isometry3d::Identity();
constexpr double kFiveDeg = 5 * M_PI / 180;

PoseEstimate solve(
    const PoseSolver::TParams& params,
    const std::vector<PointPair>& points,
    const std::vector<PlanePair>& planes,
    const std::optional<PoseGaussian>& prior = std::nullopt)
{
    return PoseSolver(params).solve(test::atRest(points, planes, kStart, prior), {});
}

/** Root of the mean squared tangent error over runs. */
double rms(PairWorld& world, const PoseSolver::TParams& params, int runs)
{
    double sum = 0;
    for (int i = 0; i < runs; ++i)
    {
        const PoseEstimate e = solve(params, world.drawPoints(), world.drawPlanes());
        sum += leftError(world.T_prev_cur, e.pose().mean).squaredNorm();
    }
    return std::sqrt(sum / runs);
}

/** Distance of an estimate from a pose, in its standard deviations. */
double sigmasFrom(const Eigen::Isometry3d& T, const PoseEstimate& estimate)
{
    const Vector6d e = leftError(T, estimate.pose().mean);
    return std::sqrt(e.dot(estimate.pose().cov.ldlt().solve(e)));
}

/** What a motion model says: 2 cm, 1 degree. */
PoseGaussian loosePrior()
{
    PoseGaussian prior;
    prior.cov.diagonal() << Eigen::Vector3d::Constant(4e-4), Eigen::Vector3d::Constant(3e-4);
    return prior;
}
}  // namespace

TEST(PoseSolver, recoversExactMotionFromFiveDegreesAndFiveCentimetres)
{
    for (const char* weighting : {"full", "diagonal", "none"})
    {
        for (const char* residual : {"minimal", "closestPoint"})
        {
            for (const auto& [numPoints, numPlanes] :
                 {std::pair(40, 0),
                  std::pair(3, 0),
                  std::pair(0, 4),
                  std::pair(2, 1),
                  std::pair(30, 4)})
            {
                SCOPED_TRACE(
                    testing::Message() << weighting << " " << residual << " " << numPoints
                                       << " points " << numPlanes << " planes");
                PairWorld world(7);
                world.addPoints(numPoints);
                world.addPlanes(numPlanes);
                PoseSolver::TParams params;
                params.weighting = weighting;
                params.planeResidual = residual;
                params.maxIterations = 100;
                for (int i = 0; i < 5; ++i)
                {
                    world.T_prev_cur = world.randomMotion(0.05, kFiveDeg);
                    const PoseEstimate estimate =
                        solve(params, world.drawPoints(0), world.drawPlanes(0));
                    EXPECT_LT(estimate.iterations, params.maxIterations);
                    EXPECT_LT(sigmasFrom(world.T_prev_cur, estimate), 0.02);
                    EXPECT_THAT(
                        estimate.pose().mean, test::IsNearPose(world.T_prev_cur, 1e-4, 1e-4));
                }
            }
        }
    }
}

TEST(PoseSolver, anyStartWithinFiveDegreesAndFiveCentimetresGivesTheSameAnswer)
{
    PairWorld world(8);
    world.addPoints(50);
    world.addPlanes(4);
    world.T_prev_cur = world.randomMotion(0.03, 0.02);
    const auto points = world.drawPoints();
    const auto planes = world.drawPlanes();
    const PoseSolver solver({});
    const PoseEstimate reference =
        solver.solve(test::atRest(points, planes), {world.T_prev_cur, Vector6d::Zero()});
    EXPECT_LT(reference.iterations, PoseSolver::TParams().maxIterations);
    for (int i = 0; i < 50; ++i)
    {
        const Eigen::Isometry3d start = world.randomMotion(0.05, kFiveDeg) * world.T_prev_cur;
        const PoseEstimate estimate =
            solver.solve(test::atRest(points, planes), {start, Vector6d::Zero()});
        EXPECT_LT(estimate.iterations, PoseSolver::TParams().maxIterations);
        EXPECT_LT(sigmasFrom(reference.pose().mean, estimate), 0.05);
    }
}

/** The weights of residuals turn with the motion. That must not keep the search from the place
 * where their gradient vanishes, nor make it slow. */
TEST(PoseSolver, weightsThatTurnWithTheMotionDoNotStopTheSearch)
{
    for (unsigned seed = 0; seed < 40; ++seed)
    {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        PairWorld world(seed);
        world.addPoints(60);
        world.addPlanes(3);
        world.T_prev_cur = world.randomMotion(0.3, 0.5);
        std::vector<PointPair> points = world.drawPoints();
        for (size_t i = 0; i < points.size(); i += 2)
        {
            points[i].cur.mean += 5 * world.sampler().sample(points[i].cur.cov);
        }
        const PoseProblem problem = test::atRest(points, world.drawPlanes(3));
        PoseSolver::TParams params;
        const PoseEstimate estimate = PoseSolver(params).solve(problem, {});
        EXPECT_LT(estimate.iterations, params.maxIterations);
        params.maxIterations = 1000;
        const PoseEstimate again = PoseSolver(params).solve(problem, estimate.motion.mean);
        EXPECT_LT(sigmasFrom(again.pose().mean, estimate), 0.05);
    }
}

/** The minimum of [P17 Eq. 10], whose weights are held while the gradient is taken: Tukey's for
 * points, none for planes, however far off they are. */
TEST(PoseSolver, gradientOfThePapersCostVanishes)
{
    for (const auto& [weighting, tukeySigmas] :
         {std::pair("full", 0.0), {"diagonal", 0.0}, {"diagonal", 4.685}})
    {
        PairWorld world(9);
        world.addPoints(20);
        world.addPlanes(5);
        world.T_prev_cur = world.randomMotion(0.03, 0.03);
        PoseSolver::TParams params = test::gaussianSolver();
        params.weighting = weighting;
        params.planeResidual = "closestPoint";
        params.alpha = 10;
        params.tukeySigmas = tukeySigmas;
        params.maxIterations = 200;
        auto points = world.drawPoints();
        auto planes = world.drawPlanes();
        points[0].cur.mean.x() += 0.01;
        points[1].cur.mean.z() += 0.5;
        planes[0].cur.theta_m *= 1.02;
        const PoseEstimate e = solve(params, points, planes);
        Vector6d gradient = Vector6d::Zero();
        Matrix6d H = Matrix6d::Zero();
        const auto weightsOf = [&, full = params.weighting == "full"](const Residual& r)
        {
            const Eigen::Matrix3d diagonal = r.cov.diagonal().cwiseInverse().asDiagonal();
            return full ? Eigen::Matrix3d(r.cov.inverse()) : diagonal;
        };
        const auto add = [&](const Residual& r, double factor)
        {
            gradient += factor * r.J.transpose() * weightsOf(r) * r.r;
            H += factor * r.J.transpose() * weightsOf(r) * r.J;
        };
        std::vector<double> norms;
        for (const PointPair& pair : points)
        {
            const Residual r = pointResidual(pair, e.motion.mean);
            norms.push_back(r.r.dot(weightsOf(r) * r.r));
        }
        std::vector<double> relative;
        for (const double norm : norms)
        {
            relative.push_back(norm / medianChi2(3));
        }
        const double limit = tukeySigmas * std::max(1.0, std::sqrt(medianVariance(relative)));
        for (size_t i = 0; i < points.size(); ++i)
        {
            const double u = std::sqrt(norms[i]) / limit;
            add(pointResidual(points[i], e.motion.mean),
                limit == 0 ? 1
                : u < 1    ? std::pow(1 - u * u, 2)
                           : 0);
        }
        for (const PlanePair& pair : planes)
        {
            add(planeResidualClosestPoint(pair, e.motion.mean), 10);
        }
        // The step that the gradient still asks for, in sigmas.
        EXPECT_LT(std::sqrt(test::squaredMahalanobis(gradient, H)), 1e-2)
            << weighting << ", " << tukeySigmas;
    }
}

/** A pair counts as an inlier where its Tukey weight (1 - (r / limit)^2)^2 is above one half. */
TEST(PoseSolver, inliersArePairsOfMoreThanHalfTheirWeight)
{
    PairWorld world(3);
    world.addPoints(60);
    world.T_prev_cur = world.randomMotion(0.05, kFiveDeg);
    const PoseSolver::TParams params;
    for (const auto& [share, expected] : {std::pair(0.45, 60), std::pair(0.65, 59)})
    {
        std::vector<PointPair> pairs = world.drawPoints(0);
        const Eigen::Matrix3d cov =
            pointResidual(pairs[0], Motion{world.T_prev_cur, Vector6d::Zero()}).cov;
        const Eigen::Vector3d sigmas = Eigen::Matrix3d(cov.llt().matrixL()).col(0);
        pairs[0].ref.mean += share * params.tukeySigmas * sigmas;
        EXPECT_EQ(solve(params, pairs, {}).numPointInliers, expected) << share;
    }
}

TEST(PoseSolver, fullAndDiagonalWeightsAgreeOnDiagonalCovariances)
{
    PairWorld world(10);
    world.addPoints(30);
    auto points = world.drawPoints();
    for (PointPair& pair : points)
    {
        pair.ref.cov = 1e-4 * Eigen::Matrix3d::Identity();
        pair.cur.cov = 2e-4 * Eigen::Matrix3d::Identity();
    }
    PoseSolver::TParams full = test::gaussianSolver(), diagonal = test::gaussianSolver();
    diagonal.weighting = "diagonal";
    const PoseEstimate a = solve(full, points, {}), b = solve(diagonal, points, {});
    EXPECT_THAT(a.pose().mean, test::IsNearPose(b.pose().mean, 1e-9, 1e-9));
    EXPECT_LT(test::whitenedDifference(a.pose().cov, b.pose().cov), 1e-6);
}

TEST(PoseSolver, unweightedMotionDoesNotDependOnCovariances)
{
    PairWorld world(11);
    world.addPoints(30);
    auto points = world.drawPoints();
    PoseSolver::TParams params = test::gaussianSolver();
    params.weighting = "none";
    const PoseEstimate a = solve(params, points, {});
    for (size_t i = 0; i < points.size(); ++i)
    {
        points[i].cur.cov *= 1.0 + static_cast<double>(i);
    }
    const PoseEstimate b = solve(params, points, {});
    EXPECT_THAT(a.pose().mean, test::IsNearPose(b.pose().mean, 1e-12, 1e-12));
    EXPECT_GT(b.pose().cov.trace(), a.pose().cov.trace());
}

TEST(PoseSolver, moreOfTheCovarianceGivesMoreAccuracy)
{
    PairWorld world(12);
    world.addPoints(40);
    world.T_prev_cur = world.randomMotion(0.02, 0.02);
    PoseSolver::TParams params = test::gaussianSolver();
    const double full = rms(world, params, 200);
    params.weighting = "diagonal";
    const double diagonal = rms(world, params, 200);
    params.weighting = "none";
    const double none = rms(world, params, 200);
    EXPECT_LT(full, 0.9 * diagonal);
    EXPECT_LT(diagonal, 0.9 * none);
}

TEST(PoseSolver, alphaWeighsPlanes)
{
    PairWorld world(13);
    world.addPoints(20);
    world.addPlanes(4);
    const auto points = world.drawPoints();
    auto planes = world.drawPlanes();
    PoseSolver::TParams params = test::gaussianSolver();
    params.alpha = 0;
    const PoseEstimate without = solve(params, points, planes), none = solve(params, points, {});
    EXPECT_THAT(without.pose().mean, test::IsNearPose(none.pose().mean, 1e-9, 1e-9));
    double previous = 1e9;
    for (const double alpha : {0.1, 1.0, 10.0, 100.0})
    {
        params.alpha = alpha;
        const PoseEstimate e = solve(params, points, planes);
        EXPECT_LT(e.planeChi2PerDof, previous);
        previous = e.planeChi2PerDof;
    }
}

TEST(PoseSolver, informationOfPlanesIsFreeOfAlpha)
{
    PairWorld world(14);
    world.addPlanes(5);
    const auto planes = world.drawPlanes(0);
    PoseSolver::TParams params = test::gaussianSolver();
    const Matrix6d one = solve(params, {}, planes).infoPlanes;
    params.alpha = 10;
    EXPECT_TRUE(solve(params, {}, planes).infoPlanes.isApprox(one, 1e-5));
}

TEST(PoseSolver, noiseFactorsScaleTheCovariance)
{
    PairWorld world(15);
    world.addPoints(30);
    world.addPlanes(5);
    const auto points = world.drawPoints();
    const auto planes = world.drawPlanes();
    PoseSolver::TParams params = test::gaussianSolver();
    const PoseEstimate one = solve(params, points, planes);
    PoseProblem noisier = test::atRest(points, planes);
    noisier.noise = {25, 25};
    const PoseEstimate scaled = PoseSolver(params).solve(noisier, {});
    EXPECT_THAT(scaled.pose().mean, test::IsNearPose(one.pose().mean, 1e-6, 1e-6));
    EXPECT_LT(test::whitenedDifference(scaled.pose().cov, (25 * one.pose().cov).eval()), 1e-3);
}

TEST(PoseSolver, tukeyIgnoresThirtyPercentOfOutliers)
{
    PairWorld world(16);
    world.addPoints(100);
    world.T_prev_cur = world.randomMotion(0.03, 0.02);
    PoseSolver::TParams plain = test::gaussianSolver();
    double clean = 0, robust = 0, harmed = 0;
    for (int run = 0; run < 50; ++run)
    {
        auto points = world.drawPoints();
        const auto error = [&](const PoseEstimate& e)
        { return leftError(world.T_prev_cur, e.pose().mean).squaredNorm(); };
        clean += error(solve(plain, points, {}));
        for (size_t i = 0; i < 30; ++i)
        {
            points[i].cur.mean += 0.3 * world.sampler().vector<3>();
        }
        const PoseEstimate e = solve({}, points, {});
        robust += error(e);
        harmed += error(solve(plain, points, {}));
        EXPECT_NEAR(e.numPointInliers, 70, 12);
    }
    EXPECT_LT(robust, 1.5 * 1.5 * clean);
    EXPECT_GT(harmed, 10 * 10 * clean);
}

/** Points count for the scale by their surface; one that is far away must not set it alone. */
TEST(PoseSolver, oneWrongFarPointDoesNotOpenTheGate)
{
    PairWorld world(33);
    for (int i = 0; i < 60; ++i)
    {
        const double z = world.sampler().uniform(1, 2);
        world.addPoint(
            {z * world.sampler().uniform(-0.5, 0.5), z * world.sampler().uniform(-0.4, 0.4), z});
    }
    world.addPoint({1, 1, 16});
    std::vector<PointPair> points = world.drawPoints();
    for (size_t i = 0; i < 20; ++i)
    {
        points[i].cur.mean.x() += 0.1;  // on something that moves
    }
    points.back().cur.mean.x() += 8;
    const PoseEstimate estimate = solve({}, points, {});
    EXPECT_LT(sigmasFrom(world.T_prev_cur, estimate), 4);
    EXPECT_LE(estimate.numPointInliers, 40);
}

TEST(PoseSolver, fewPointsThatTellADirectionAreBelieved)
{
    // Many points on vertical edges, which tell nothing of the height; eight corners, which have
    // moved by seven sigma more than was foreseen; and one that is none and stays where it was.
    PairWorld world(11);
    world.addPoints(60);
    world.T_prev_cur.translation() << 0, 0.02, 0;
    std::vector<PointPair> points = world.drawPoints(0);
    for (size_t i = 0; i < points.size(); ++i)
    {
        PointPair& pair = points[i];
        const double alongEdge = i < 9 ? 0.002 : 4;
        pair.ref.cov = pair.cur.cov =
            Eigen::Vector3d(0.002, alongEdge, 0.01).cwiseAbs2().asDiagonal();
    }
    points[8].cur.mean.y() += 0.02;
    const PoseProblem problem = test::atRest(points, {}, kStart, loosePrior());
    const PoseEstimate estimate = PoseSolver({}).solve(problem, {}, 5);
    EXPECT_THAT(estimate.pose().mean, test::IsNearPose(world.T_prev_cur, 1e-3, 1e-3));
    EXPECT_EQ(estimate.numPointInliers, 59);
    // If none of them is far off for the start, all are left out.
    EXPECT_EQ(PoseSolver({}).solve(problem, {}).numPointInliers, 52);
}

TEST(PoseSolver, studentTBearsAWrongPlane)
{
    PairWorld world(17);
    world.addPlanes(8);
    double robust = 0, harmed = 0;
    for (int run = 0; run < 50; ++run)
    {
        auto planes = world.drawPlanes();
        planes[3].cur.theta_m *= 1.05;  // 5 cm per metre
        const auto error = [&](const PoseSolver::TParams& params) {
            return leftError(world.T_prev_cur, solve(params, {}, planes).pose().mean).squaredNorm();
        };
        robust += error({});
        harmed += error(test::gaussianSolver());
    }
    EXPECT_LT(robust, 0.1 * harmed);
}

/** One bad feature must not take the place of all the others. */
/** A prediction that is off by more than expected counts as Student's t says: as a Gaussian one
 * whose information is (dof + 6) / (dof + its squared norm) of what it claims. */
TEST(PoseSolver, studentTBearsAWrongPrediction)
{
    PairWorld world(31);
    world.addPoints(4);
    PoseSolver::TParams student = test::gaussianSolver();
    student.priorStudentDof = 5;
    student.maxIterations = 100;
    PoseGaussian prior;
    prior.cov = 1e-4 * Matrix6d::Identity();
    const auto norm2 = [&](const PoseEstimate& e)
    { return leftError(e.pose().mean, prior.mean).squaredNorm() / 1e-4; };
    const auto meanWith = [&](const PoseSolver::TParams& params, double weight)
    {
        const PoseGaussian weighed{prior.mean, prior.cov / weight};
        return solve(params, world.drawPoints(0), {}, weighed);
    };

    world.T_prev_cur.translation().x() = 0.06;
    const PoseEstimate robust = meanWith(student, 1);
    ASSERT_GT(norm2(robust), 12);
    const double weight = 11 / (5 + norm2(robust));
    const auto gaussian = [&](double factor)
    {
        PoseSolver::TParams params = test::gaussianSolver();
        params.maxIterations = 100;
        return meanWith(params, factor);
    };
    EXPECT_LT(sigmasFrom(gaussian(weight).pose().mean, robust), 0.05);
    EXPECT_GT(
        (robust.pose().mean.translation() - gaussian(1).pose().mean.translation()).norm(), 1e-3);

    world.T_prev_cur.translation().x() = 0.01;
    const PoseEstimate expected = meanWith(student, 1);
    ASSERT_LT(norm2(expected), 6);
    EXPECT_THAT(expected.pose().mean, test::IsNearPose(gaussian(1).pose().mean, 1e-9, 1e-9));
}

TEST(PoseSolver, pairsThatAreNotFiniteCountForNothing)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    PairWorld world(17);
    world.addPoints(30);
    world.addPlanes(4);
    world.T_prev_cur = world.randomMotion(0.03, 0.02);
    const auto points = world.drawPoints();
    const auto planes = world.drawPlanes();
    for (const char* weighting : {"full", "none"})
    {
        PoseSolver::TParams params;
        params.weighting = weighting;
        const PoseSolver solver(params);
        const PoseProblem good = test::atRest(points, planes, kStart, loosePrior());
        const PoseEstimate expected = solver.solve(good, {});
        const PoseAnalysis analysis = solver.analyse(good, expected);
        for (const double bad : {nan, infinite, -infinite})
        {
            PoseProblem problem = good;
            for (int i = 0; i < 3; ++i)
            {
                problem.points.insert(problem.points.begin(), points.front());
                problem.planes.push_back(planes.front());
            }
            problem.points[0].cur.mean.z() = bad;
            problem.points[1].ref.cov(0, 0) = bad;
            problem.points[2].ref.mean.x() = bad;
            const auto plane = problem.planes.end() - 3;
            plane[0].ref.theta_m.y() = bad;
            plane[1].cur.cov_m(1, 2) = bad;
            plane[2].cur.theta_m.z() = bad;
            const PoseEstimate estimate = solver.solve(problem, {});
            EXPECT_THAT(estimate.pose().mean, test::IsNearPose(expected.pose().mean, 1e-12, 1e-12));
            EXPECT_TRUE(estimate.pose().cov.isApprox(expected.pose().cov, 1e-9));
            EXPECT_EQ(estimate.numPointInliers, expected.numPointInliers);
            EXPECT_NEAR(estimate.planeChi2PerDof, expected.planeChi2PerDof, 1e-9);
            const PoseAnalysis same = solver.analyse(problem, estimate);
            EXPECT_NEAR(same.pointVariance, analysis.pointVariance, 1e-9);
            EXPECT_NEAR(same.planeVariance, analysis.planeVariance, 1e-9);
            EXPECT_TRUE(same.sensitivity.points.isApprox(analysis.sensitivity.points, 1e-9));
            EXPECT_EQ(same.pointWeights.front(), 0);
        }
    }
}

TEST(PoseSolver, withoutPairsThePriorRemains)
{
    PairWorld world(18);
    PoseGaussian prior;
    prior.mean = world.randomMotion(0.1, 0.1);
    prior.cov = world.sampler().covariance<6>(1e-6, 1e-3);
    const PoseEstimate e = solve({}, {}, {}, prior);
    EXPECT_LT(e.iterations, PoseSolver::TParams().maxIterations);
    EXPECT_THAT(e.pose().mean, test::IsNearPose(prior.mean, 1e-6, 1e-6));
    EXPECT_LT(test::whitenedDifference(e.pose().cov, prior.cov), 1e-3);
    EXPECT_EQ(e.pointChi2PerDof, 0);
    EXPECT_EQ(e.planeChi2PerDof, 0);
    EXPECT_EQ(e.infoPoints, Matrix6d::Zero());
}

TEST(PoseSolver, withoutAnythingTheStartRemainsAndNothingIsKnown)
{
    PairWorld world(19);
    const Eigen::Isometry3d start = world.randomMotion(0.1, 0.1);
    const PoseEstimate e = PoseSolver({}).solve({}, {start, Vector6d::Zero()});
    EXPECT_THAT(e.pose().mean, test::IsNearPose(start, 1e-12, 1e-12));
    EXPECT_TRUE(isPositiveDefinite(e.pose().cov));
    EXPECT_GT(e.pose().cov.diagonal().minCoeff(), 1e6);
}

/** One wall: seen are the distance and two angles; the rest is as uncertain as before. */
TEST(PoseSolver, unobservableDirectionsKeepThePriorsCovariance)
{
    PairWorld world(20);
    world.addPlane({0, 0, -1}, 2);
    const PoseGaussian prior = loosePrior();
    for (const double studentDof : {0.0, 5.0})
    {
        PoseSolver::TParams params;
        params.planeStudentDof = studentDof;
        const PoseEstimate e = solve(params, {}, world.drawPlanes(), prior);
        const Matrix6d& cov = e.pose().cov;
        for (const int i : {0, 1, 5})  // x, y, about z
        {
            EXPECT_NEAR(cov(i, i), prior.cov(i, i), 0.01 * prior.cov(i, i)) << i;
        }
        for (const int i : {2, 3, 4})
        {
            EXPECT_LT(cov(i, i), 0.1 * prior.cov(i, i)) << i;
        }
        // And their estimate stays where the prior was.
        const Vector6d moved = se3Log(e.pose().mean);
        EXPECT_LT(std::abs(moved[0]) + std::abs(moved[1]) + std::abs(moved[5]), 1e-4);
    }
}

/** Two planes tell all but the way along their common line; points far away know nothing else as
 * well as these do. */
TEST(PoseSolver, supportIsTheNumberOfPointsWhereNothingElseHolds)
{
    const auto support = [](int points, int references, const PoseGaussian& prior)
    {
        PairWorld world(22);
        world.addPlane({1, 0, -1}, 1);
        world.addPlane({-1, 0, -1}, 1);
        PoseProblem problem = test::atRest({}, world.drawPlanes(0), prior.mean, prior);
        for (int i = 0; i < points; ++i)
        {
            PairWorld one(22);
            one.addPoint({0, 0, 5});
            for (int r = 0; r < references; ++r)
            {
                problem.points.push_back(one.drawPoints(0).front());
                problem.points.back().feature = i;
                problem.points.back().reference = r;
            }
        }
        const PoseSolver solver(test::gaussianSolver());
        return solver.pointSupport(problem, solver.solve(problem, problem.prior.mean));
    };
    const PoseGaussian loose{Eigen::Isometry3d::Identity(), Matrix6d::Identity()};
    const PoseGaussian tight{Eigen::Isometry3d::Identity(), 1e-10 * Matrix6d::Identity()};
    constexpr double kNone = std::numeric_limits<double>::infinity();
    for (const int n : {1, 5, 20})
    {
        EXPECT_NEAR(support(n, 1, loose), n, 1e-6);
        EXPECT_NEAR(support(n, 3, loose), n, 1e-6) << "a point seen by three references is one";
        EXPECT_EQ(support(n, 1, tight), kNone) << "the prior knows it better";
    }
    EXPECT_EQ(support(0, 1, loose), kNone);
}

/** One point that is known a hundred times better than the others counts for nearly all. */
TEST(PoseSolver, supportCountsPointsByWhatTheyKnow)
{
    PairWorld world(23);
    world.addPoints(40);
    PoseProblem problem = test::atRest(world.drawPoints(0), {}, kStart, loosePrior());
    const PoseSolver solver(test::gaussianSolver());
    const auto support = [&] { return solver.pointSupport(problem, solver.solve(problem, {})); };
    const double all = support();
    EXPECT_GT(all, 10);
    EXPECT_LE(all, 40);
    for (size_t i = 3; i < problem.points.size(); ++i)
    {
        problem.points[i].ref.cov *= 1e4;
        problem.points[i].cur.cov *= 1e4;
    }
    EXPECT_LT(support(), 3.1);
}

TEST(PoseSolver, parallelPlanesLeaveSlidingOpen)
{
    // A corridor along z: walls and nothing else.
    PairWorld world(21);
    world.addPlane({1, 0, 0}, 1);
    world.addPlane({-1, 0, 0}, 1.2);
    const PoseGaussian prior = loosePrior();
    const PoseEstimate e = solve({}, {}, world.drawPlanes(), prior);
    for (const int i : {1, 2, 3})  // y, z, about x
    {
        EXPECT_NEAR(e.pose().cov(i, i), prior.cov(i, i), 0.01 * prior.cov(i, i)) << i;
    }
    EXPECT_LT(e.pose().cov(0, 0), 0.05 * prior.cov(0, 0));
}

TEST(PoseSolver, collinearPointsLeaveTheTurnAboutTheirLineOpen)
{
    // Along x at y = 0, z = 2: the turn about that line moves the camera in y and z too.
    PairWorld world(22);
    for (int i = 0; i < 20; ++i)
    {
        world.addPoint({-1 + 0.1 * i, 0, 2});
    }
    const PoseGaussian prior = loosePrior();
    const PoseEstimate e = solve({}, world.drawPoints(), {}, prior);
    Vector6d turn;
    turn << Eigen::Vector3d(0, 0, 2).cross(Eigen::Vector3d::UnitX()), Eigen::Vector3d::UnitX();
    const Matrix6d info = test::inverse(e.pose().cov), priorInfo = test::inverse(prior.cov);
    EXPECT_NEAR(turn.dot(info * turn), turn.dot(priorInfo * turn), 0.02 * turn.dot(info * turn));
    EXPECT_LT(e.pose().cov(4, 4), 0.05 * prior.cov(4, 4));
    EXPECT_TRUE(isPositiveDefinite(e.pose().cov));
}

/** A caller's gate on the largest eigenvalue sees them. */
TEST(PoseSolver, degenerateConfigurationsWithoutPriorSaySo)
{
    PairWorld onePoint(23), onePlane(24), twoPoints(25), parallel(28);
    onePoint.addPoint({0.1, 0.2, 2});
    onePlane.addPlane({0, 0, -1}, 2);
    twoPoints.addPoint({0.1, 0.2, 2});
    twoPoints.addPoint({0.5, 0.1, 2.5});
    parallel.addPlane({0, 0, -1}, 2);
    parallel.addPlane({0, 0, -1}, 2.5);
    parallel.addPlane({0, 0, -1}, 3);
    for (PairWorld* world : {&onePoint, &onePlane, &twoPoints, &parallel})
    {
        const PoseEstimate e = solve({}, world->drawPoints(), world->drawPlanes());
        EXPECT_TRUE(e.pose().mean.matrix().allFinite());
        ASSERT_TRUE(e.pose().cov.allFinite());
        EXPECT_GT(test::symmetricEigen(e.pose().cov).values.maxCoeff(), 0.3 * 0.3);
    }
}

TEST(PoseSolver, chiSquarePerDegreeOfFreedomIsOneForRightCovariances)
{
    PairWorld world(26);
    world.addPoints(150);
    world.addPlanes(30);
    double points = 0, planes = 0;
    for (int i = 0; i < 20; ++i)
    {
        const PoseEstimate e =
            solve(test::gaussianSolver(), world.drawPoints(), world.drawPlanes());
        points += e.pointChi2PerDof / 20;
        planes += e.planeChi2PerDof / 20;
    }
    EXPECT_NEAR(points, 1, 0.05);
    EXPECT_NEAR(planes, 1, 0.1);
    const PoseEstimate e = solve(test::gaussianSolver(), world.drawPoints(3), world.drawPlanes(2));
    EXPECT_NEAR(e.pointChi2PerDof, 9, 1.5);
    EXPECT_NEAR(e.planeChi2PerDof, 4, 1.5);
}

TEST(PoseSolver, sameInputGivesTheSameBits)
{
    PairWorld world(27);
    world.addPoints(40);
    world.addPlanes(4);
    const auto points = world.drawPoints();
    const auto planes = world.drawPlanes();
    const PoseEstimate a = solve({}, points, planes), b = solve({}, points, planes);
    EXPECT_EQ(a.pose().mean.matrix(), b.pose().mean.matrix());
    EXPECT_EQ(a.pose().cov, b.pose().cov);
}

TEST(PoseSolver, refusesParametersOutOfRange)
{
    const auto refused = [](auto change)
    {
        PoseSolver::TParams params;
        change(params);
        EXPECT_THROW(PoseSolver{params}, std::invalid_argument);
    };
    refused([](auto& p) { p.weighting = "some"; });
    refused([](auto& p) { p.planeResidual = "some"; });
    refused([](auto& p) { p.alpha = -1; });
    refused([](auto& p) { p.alpha = 1e4; });
    refused(
        [](auto& p)
        {
            p.planeResidual = "closestPoint";
            p.alpha = 1e9;
        });
    refused([](auto& p) { p.tukeySigmas = -1; });
    refused([](auto& p) { p.planeStudentDof = -1; });
    refused([](auto& p) { p.priorStudentDof = -1; });
    refused([](auto& p) { p.maxIterations = 0; });

    PoseSolver::TParams inMetres;
    inMetres.planeResidual = "closestPoint";
    inMetres.alpha = 1e7;  // docs/paper_figures.md, Fig. 3
    EXPECT_NO_THROW(PoseSolver{inMetres});
}
}  // namespace pointplane
