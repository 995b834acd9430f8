// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>

#include <Eigen/LU>

#include <cmath>

#include "matchers.h"
#include "monte_carlo.h"
#include "numeric_jacobian.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

namespace
{
constexpr double kPi = 3.14159265358979323846;

/** Rotation angles over the scales at which formulas switch. */
const std::vector<double> kAngles{0, 1e-12, 1e-8, 0.99e-5, 1.01e-5, 0.99e-2, 1.01e-2, 0.3, 2, 3.1};

Vector6d randomTangent(GaussianSampler& random, double angle)
{
    Vector6d xi;
    xi << random.vector<3>(), angle * random.vector<3>().normalized();
    return xi;
}
}  // namespace

TEST(se3, quarterTurnByHand)
{
    const Eigen::Isometry3d T = se3Exp((Vector6d() << 0, 0, 2, 0, 0, kPi / 2).finished());
    Eigen::Isometry3d expected = Eigen::Isometry3d::Identity();
    expected.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    expected.translation() << 0, 0, 2;  // along the axis: not bent
    EXPECT_THAT(T, IsNearPose(expected, 1e-15, 1e-15));

    // Half a turn at unit speed along x runs over half a circle of diameter 2 / pi, towards +y.
    const Eigen::Isometry3d half = se3Exp((Vector6d() << 1, 0, 0, 0, 0, kPi).finished());
    EXPECT_THAT(half.translation(), IsMatrixNear(Eigen::Vector3d(0, 2 / kPi, 0), 1e-15));
}

TEST(se3, hatIsCrossProduct)
{
    const Eigen::Vector3d a(1, 2, 3), b(-4, 0.5, 7);
    EXPECT_THAT((hat(a) * b).eval(), IsMatrixNear(a.cross(b), 0.0));
}

TEST(se3, expLogRoundTripAtEveryScale)
{
    GaussianSampler random(1);
    for (const double angle : kAngles)
    {
        for (int i = 0; i < 20; ++i)
        {
            const Vector6d xi = randomTangent(random, angle);
            EXPECT_THAT(se3Log(se3Exp(xi)), IsMatrixNear(xi, 1e-12)) << "angle " << angle;
            EXPECT_THAT(
                (se3Exp(xi) * se3Exp(-xi)), IsNearPose(Eigen::Isometry3d::Identity(), 1e-14, 1e-13))
                << "angle " << angle;
        }
    }
}

TEST(se3, logNearHalfTurn)
{
    GaussianSampler random(2);
    for (const double belowPi : {1e-3, 1e-6, 1e-9, 0.0})
    {
        const Eigen::Vector3d axis = random.vector<3>().normalized();
        const Eigen::Matrix3d R = Eigen::AngleAxisd(kPi - belowPi, axis).toRotationMatrix();
        const Eigen::Vector3d omega = so3Log(R);
        EXPECT_NEAR(omega.norm(), kPi - belowPi, 1e-12);
        EXPECT_THAT(so3Exp(omega), IsMatrixNear(R, 1e-12)) << "below pi by " << belowPi;
    }
}

TEST(se3, exponentialIsARotation)
{
    GaussianSampler random(3);
    for (const double angle : kAngles)
    {
        const Eigen::Matrix3d R = so3Exp(angle * random.vector<3>().normalized());
        EXPECT_THAT((R.transpose() * R).eval(), IsMatrixNear(Eigen::Matrix3d::Identity(), 1e-14));
        EXPECT_NEAR(R.determinant(), 1, 1e-14);
    }
}

TEST(se3, translationIsTheIntegralOfTheTwist)
{
    // exp(xi) as the product of many small steps: independent of the closed form of V.
    GaussianSampler random(4);
    const Vector6d xi = randomTangent(random, 1.3);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    constexpr int kSteps = 1 << 12;
    Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
    step.linear() = Eigen::AngleAxisd(1.3 / kSteps, xi.tail<3>().normalized()).toRotationMatrix();
    step.translation() =
        xi.head<3>() / kSteps + 0.5 * xi.tail<3>().cross(xi.head<3>()) / kSteps / kSteps;
    for (int i = 0; i < kSteps; ++i)
    {
        T = T * step;
    }
    EXPECT_THAT(T, IsNearPose(se3Exp(xi), 1e-9, 1e-7));
}

TEST(se3, adjointMovesTangents)
{
    GaussianSampler random(5);
    for (int i = 0; i < 20; ++i)
    {
        const Eigen::Isometry3d T = se3Exp(randomTangent(random, 2));
        const Vector6d xi = randomTangent(random, 0.7);
        EXPECT_THAT(
            T * se3Exp(xi) * T.inverse(), IsNearPose(se3Exp(adjoint(T) * xi), 1e-13, 1e-12));
    }
}

TEST(se3, leftPerturbationOfAPoint)
{
    // d(exp(xi) p)/dxi = [I, -hat(p)] at xi = 0: the derivative every solver here relies on.
    const Eigen::Vector3d p(0.3, -1.2, 2.5);
    const auto J = numericJacobian(
        [&](const Vector6d& xi) { return (se3Exp(xi) * p).eval(); }, Vector6d::Zero());
    Matrix36d expected;
    expected << Eigen::Matrix3d::Identity(), -hat(p);
    EXPECT_THAT(J, IsMatrixNear(expected, 1e-9));
}

TEST(se3, nearestRotationTurnsVectorsOntoOthers)
{
    const Eigen::Matrix3d R = so3Exp({0.5, -1.2, 2});
    Eigen::Matrix<double, 3, 4> b;
    b << 1, 0.2, -3, 1, 0, 2, 0.5, 1, 0.3, 0.1, 1, -2;
    EXPECT_TRUE(nearestRotation(R * b * b.transpose()).isApprox(R, 1e-12));
    // Of points in a plane, too, and never a mirror image.
    b.row(2).setZero();
    EXPECT_TRUE(nearestRotation(R * b * b.transpose()).isApprox(R, 1e-12));
    EXPECT_NEAR(nearestRotation(-Eigen::Matrix3d::Identity()).determinant(), 1, 1e-12);
}

TEST(se3, orthonormalisedRepairsDrift)
{
    GaussianSampler random(6);
    Eigen::Isometry3d T = se3Exp(randomTangent(random, 1));
    const Eigen::Isometry3d exact = T;
    T.linear() += 1e-6 * Eigen::Matrix3d::Random();
    const Eigen::Isometry3d fixed = orthonormalised(T);
    EXPECT_THAT(
        (fixed.linear().transpose() * fixed.linear()).eval(),
        IsMatrixNear(Eigen::Matrix3d::Identity(), 1e-15));
    EXPECT_THAT(fixed, IsNearPose(exact, 3e-6, 0.0));
}
