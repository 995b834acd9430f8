// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/pose/residuals.h>

#include <vector>

#include "matchers.h"
#include "monte_carlo.h"
#include "numeric_jacobian.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
Eigen::Isometry3d quarterTurn()
{
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    T.translation() << 1, 2, 3;
    return T;
}

Eigen::Isometry3d randomPose(test::GaussianSampler& sampler)
{
    return se3Exp(0.3 * sampler.vector<6>());
}

Motion still(const Eigen::Isometry3d& T) { return {T, Vector6d::Zero()}; }

Motion randomMotion(test::GaussianSampler& sampler)
{
    return {randomPose(sampler), sampler.vector<6>()};
}

Matrix36d randomMatrix36(test::GaussianSampler& sampler)
{
    Matrix36d out;
    out << sampler.vector<6>().transpose(), sampler.vector<6>().transpose(),
        sampler.vector<6>().transpose();
    return out;
}

PointPair randomPointPair(test::GaussianSampler& sampler)
{
    return {
        {sampler.vector<3>(), sampler.covariance<3>(1e-4, 1e-2)},
        {sampler.vector<3>(), sampler.covariance<3>(1e-4, 1e-2)},
        0.02 * randomMatrix36(sampler)};
}

PlanePair randomPlanePair(test::GaussianSampler& sampler)
{
    const Eigen::Vector3d theta(sampler.uniform(-0.3, 0.3), sampler.uniform(-0.3, 0.3), -0.5);
    return {
        {theta + 0.05 * sampler.vector<3>(), sampler.covariance<3>(1e-8, 1e-6)},
        {theta, sampler.covariance<3>(1e-8, 1e-6)},
        0.005 * randomMatrix36(sampler)};
}

/** J and J_V of any residual against central differences of the left perturbation and of the
 * velocity. */
template <class Pair, class F>
void expectJacobians(const Pair& pair, const Motion& motion, const F& residual)
{
    const auto r = [&](const Vector12d& dx) -> Eigen::Vector3d
    {
        const Eigen::Isometry3d T = se3Exp(dx.head<6>()) * motion.T_prev_cur;
        return residual(pair, Motion{T, motion.velocity + dx.tail<6>()}).r;
    };
    Eigen::Matrix<double, 3, 12> J;
    J << residual(pair, motion).J, residual(pair, motion).J_V;
    EXPECT_THAT(J, test::IsMatrixNear(test::numericJacobian(r, Vector12d::Zero().eval()), 1e-7));
}
}  // namespace

TEST(Residuals, pointByHand)
{
    PointPair pair;
    pair.ref.mean << 1.5, 3, 2;
    pair.ref.cov = Eigen::Vector3d(1, 2, 3).asDiagonal();
    pair.cur.mean << 1, 0, 0;
    pair.cur.cov = Eigen::Vector3d(4, 5, 6).asDiagonal();
    // R P + t = (0, 1, 0) + (1, 2, 3); the turn swaps the first two variances.
    const Residual r = pointResidual(pair, still(quarterTurn()));
    EXPECT_THAT(r.r, test::IsMatrixNear(Eigen::Vector3d(0.5, 0, -1), 1e-15));
    const Eigen::Matrix3d cov = Eigen::Vector3d(6, 6, 9).asDiagonal();
    EXPECT_THAT(r.cov, test::IsMatrixNear(cov, 1e-14));
    Matrix36d J;
    J << -1, 0, 0, 0, -3, 3, 0, -1, 0, 3, 0, -1, 0, 0, -1, -3, 1, 0;
    EXPECT_THAT(r.J, test::IsMatrixNear(J, 1e-14));
}

TEST(Residuals, planesByHand)
{
    // The wall z = 2 seen after 5 cm forward is at 1.95; the pair says 2.1 in the previous frame.
    PlanePair pair;
    pair.ref.theta_m << 0, 0, -1 / 2.1;
    pair.cur.theta_m << 0, 0, -1 / 2.0;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().z() = 0.05;
    EXPECT_THAT(
        planeResidualMinimal(pair, still(T)).r,
        test::IsMatrixNear(Eigen::Vector3d(0, 0, -1 / 2.1 + 1 / 2.05), 1e-15));
    // C = d n = -z n_z: metres.
    EXPECT_THAT(
        planeResidualClosestPoint(pair, still(T)).r,
        test::IsMatrixNear(Eigen::Vector3d(0, 0, -2.1 + 2.05), 1e-14));
}

/** C~ = N'R (N't + d') - dN, letter by letter [P17 Eq. 9]. */
TEST(Residuals, closestPointIsThePapersEquation)
{
    test::GaussianSampler sampler(6);
    for (int i = 0; i < 50; ++i)
    {
        const PlanePair pair = randomPlanePair(sampler);
        const Eigen::Isometry3d T = randomPose(sampler);
        const Plane ref = hessianForm(pair.ref.theta_m), cur = hessianForm(pair.cur.theta_m);
        const Eigen::RowVector3d moved = ref.n.transpose() * T.linear();
        const Eigen::Vector3d expected =
            (moved * (ref.n.dot(T.translation()) + ref.d) - cur.d * cur.n.transpose()).transpose();
        EXPECT_THAT(
            planeResidualClosestPoint(pair, still(T)).r, test::IsMatrixNear(expected, 1e-12));
    }
}

/** From Sigma_theta of N and d [P17, after Eq. 6 and after Eq. 10]: the same as from theta_m. */
TEST(Residuals, closestPointsCovarianceIsThatOfTheHessianForms)
{
    test::GaussianSampler sampler(8);
    for (int i = 0; i < 50; ++i)
    {
        const PlanePair pair = randomPlanePair(sampler);
        const Eigen::Isometry3d T = randomPose(sampler);
        const auto ofForms = [&](const Eigen::Matrix<double, 8, 1>& x) -> Eigen::Vector3d
        {
            const Eigen::Vector3d N_ref = x.head<3>(), N_cur = x.segment<3>(4);
            return T.linear().transpose() * N_ref * (N_ref.dot(T.translation()) + x[3]) -
                   x[7] * N_cur;
        };
        const Plane ref = hessianForm(pair.ref.theta_m), cur = hessianForm(pair.cur.theta_m);
        Eigen::Matrix<double, 8, 1> forms;
        forms << ref.n, ref.d, cur.n, cur.d;
        const auto J = test::numericJacobian(ofForms, forms);
        Eigen::Matrix<double, 8, 8> cov = Eigen::Matrix<double, 8, 8>::Zero();
        cov.topLeftCorner<4, 4>() = hessianCovariance(pair.ref);
        cov.bottomRightCorner<4, 4>() = hessianCovariance(pair.cur);
        EXPECT_LT(
            test::whitenedDifference(
                planeResidualClosestPoint(pair, still(T)).cov, propagate(J, cov)),
            1e-5);
    }
}

TEST(Residuals, planesMoveAsTheirHessianFormsDo)
{
    test::GaussianSampler sampler(1);
    for (int i = 0; i < 50; ++i)
    {
        const PlanePair pair = randomPlanePair(sampler);
        const Eigen::Isometry3d T = randomPose(sampler);
        const Plane expected = transformed(T, hessianForm(pair.cur.theta_m));
        EXPECT_THAT(
            transformed(T, pair.cur).theta_m, test::IsMatrixNear(minimalForm(expected), 1e-9));
    }
}

TEST(Residuals, vanishAtTheTruth)
{
    test::GaussianSampler sampler(2);
    const Eigen::Isometry3d T = randomPose(sampler);
    PointPair points = randomPointPair(sampler);
    const Motion motion{T, sampler.vector<6>()};
    points.ref.mean = T * (points.cur.mean + points.dCur_dV * motion.velocity);
    EXPECT_LT(pointResidual(points, motion).r.norm(), 1e-14);
    PlanePair planes = randomPlanePair(sampler);
    PlaneGaussian atRest = planes.cur;
    atRest.theta_m += planes.dCur_dV * motion.velocity;
    planes.ref.theta_m = transformed(T, atRest).theta_m;
    EXPECT_LT(planeResidualMinimal(planes, motion).r.norm(), 1e-14);
    EXPECT_LT(planeResidualClosestPoint(planes, motion).r.norm(), 1e-13);
}

TEST(Residuals, jacobiansAreThoseOfTheLeftPerturbationAndOfTheVelocity)
{
    test::GaussianSampler sampler(3);
    for (int i = 0; i < 50; ++i)
    {
        const Motion motion = randomMotion(sampler);
        expectJacobians(randomPointPair(sampler), motion, pointResidual);
        const PlanePair planes = randomPlanePair(sampler);
        expectJacobians(planes, motion, planeResidualMinimal);
        expectJacobians(planes, motion, planeResidualClosestPoint);
    }
}

/** Both features move with errors of the camera. */
TEST(Residuals, changeWithTheCamera)
{
    test::GaussianSampler sampler(5);
    const Motion motion = randomMotion(sampler);
    const auto check = [&](auto pair, auto residual, auto&& meanOf)
    {
        constexpr double kStep = 1e-5;
        pair.dRef_dCamera = sampler.vector<3>() * sampler.vector<kNumCameraErrors>().transpose();
        pair.dCur_dCamera = sampler.vector<3>() * sampler.vector<kNumCameraErrors>().transpose();
        const auto with = [&](const CameraVector& camera)
        {
            auto moved = pair;
            meanOf(moved.ref) += pair.dRef_dCamera * camera;
            meanOf(moved.cur) += pair.dCur_dCamera * camera;
            return residual(moved, motion).r;
        };
        ByCamera expected;
        for (int k = 0; k < kNumCameraErrors; ++k)
        {
            const CameraVector step = kStep * CameraVector::Unit(k);
            expected.col(k) = (with(step) - with(-step)) / (2 * kStep);
        }
        EXPECT_THAT(residual(pair, motion).ofCamera, test::IsMatrixNear(expected, 1e-5));
    };
    const auto point = [](auto& g) -> Eigen::Vector3d& { return g.mean; };
    const auto plane = [](auto& g) -> Eigen::Vector3d& { return g.theta_m; };
    check(randomPointPair(sampler), pointResidual, point);
    check(randomPlanePair(sampler), planeResidualMinimal, plane);
    check(randomPlanePair(sampler), planeResidualClosestPoint, plane);
}

/** The reference's features have moved with its velocity. */
TEST(Residuals, changeWithTheReferencesVelocity)
{
    test::GaussianSampler sampler(6);
    const Motion motion = randomMotion(sampler);
    const auto check = [&](auto pair, auto residual, auto&& meanOf)
    {
        pair.dRef_dV = randomMatrix36(sampler);
        const auto with = [&](const Vector6d& velocity) -> Eigen::Vector3d
        {
            auto moved = pair;
            meanOf(moved.ref) += pair.dRef_dV * velocity;
            return residual(moved, motion).r;
        };
        const Matrix36d expected = test::numericJacobian(with, Vector6d::Zero().eval());
        EXPECT_THAT(residual(pair, motion).ofReferenceVelocity, test::IsMatrixNear(expected, 1e-5));
    };
    const auto point = [](auto& g) -> Eigen::Vector3d& { return g.mean; };
    const auto plane = [](auto& g) -> Eigen::Vector3d& { return g.theta_m; };
    check(randomPointPair(sampler), pointResidual, point);
    check(randomPlanePair(sampler), planeResidualMinimal, plane);
    check(randomPlanePair(sampler), planeResidualClosestPoint, plane);
}

TEST(Residuals, covariancesOfTransformedPlanesAreOfFirstOrder)
{
    test::GaussianSampler sampler(7);
    for (int i = 0; i < 20; ++i)
    {
        const Eigen::Isometry3d T = randomPose(sampler);
        const PlaneGaussian plane = randomPlanePair(sampler).cur;
        const auto moved = [&](const Eigen::Vector3d& theta_m) -> Eigen::Vector3d
        { return minimalForm(transformed(T, hessianForm(theta_m))); };
        const Eigen::Matrix3d J = test::numericJacobian(moved, plane.theta_m);
        EXPECT_THAT(transformJacobian(T, plane.theta_m), test::IsMatrixNear(J, 1e-6));
        EXPECT_LT(
            test::whitenedDifference(transformed(T, plane).cov_m, propagate(J, plane.cov_m)), 1e-6);
    }
}

TEST(Residuals, covariancesAreThoseOfMonteCarlo)
{
    test::GaussianSampler sampler(4);
    const Motion T = randomMotion(sampler);
    const PointPair points = randomPointPair(sampler);
    const PlanePair planes = randomPlanePair(sampler);
    const Eigen::Vector3d pointMean = pointResidual(points, T).r;
    const Eigen::Vector3d minimalMean = planeResidualMinimal(planes, T).r;
    const Eigen::Vector3d closestMean = planeResidualClosestPoint(planes, T).r;
    std::vector<Eigen::Vector3d> point, minimal, closest;
    for (int i = 0; i < 20000; ++i)
    {
        PointPair p = points;
        p.ref.mean += sampler.sample(p.ref.cov);
        p.cur.mean += sampler.sample(p.cur.cov);
        point.emplace_back(pointResidual(p, T).r - pointMean);
        PlanePair m = planes;
        m.ref.theta_m += sampler.sample(m.ref.cov_m);
        m.cur.theta_m += sampler.sample(m.cur.cov_m);
        minimal.emplace_back(planeResidualMinimal(m, T).r - minimalMean);
        closest.emplace_back(planeResidualClosestPoint(m, T).r - closestMean);
    }
    // A right covariance differs by 3 / 141 on average.
    const auto difference = [](const std::vector<Eigen::Vector3d>& errors, const Residual& r)
    { return test::whitenedDifference(test::sampleCovariance(errors), r.cov); };
    EXPECT_LT(difference(point, pointResidual(points, T)), 0.05);
    EXPECT_LT(difference(minimal, planeResidualMinimal(planes, T)), 0.05);
    EXPECT_LT(difference(closest, planeResidualClosestPoint(planes, T)), 0.05);
}
}  // namespace pointplane
