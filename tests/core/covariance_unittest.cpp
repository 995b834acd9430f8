// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/types.h>

#include <limits>
#include <stdexcept>

#include "matchers.h"
#include "monte_carlo.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

TEST(covariance, propagateByHand)
{
    const Eigen::RowVector2d J(1, 2);
    Eigen::Matrix2d S;
    S << 4, 1, 1, 9;
    EXPECT_DOUBLE_EQ(propagate(J, S)(0, 0), 4 + 2 * 2 + 4 * 9);
}

TEST(covariance, propagateIsExactlySymmetric)
{
    GaussianSampler random(31);
    const Matrix6d S = random.covariance<6>(1e-8, 1);
    Matrix6d J;
    for (int i = 0; i < 36; ++i)
    {
        J.data()[i] = random.normal();
    }
    const Matrix6d out = propagate(J, S);
    EXPECT_THAT(out, IsMatrixNear(out.transpose().eval(), 0.0));
}

TEST(covariance, positiveDefiniteOrNot)
{
    GaussianSampler random(32);
    EXPECT_TRUE(isPositiveDefinite(random.covariance<6>(1e-12, 1e-6)));
    EXPECT_FALSE(isPositiveDefinite(Matrix6d::Zero()));
    EXPECT_FALSE(isPositiveDefinite((-Eigen::Matrix3d::Identity()).eval()));
    Eigen::Matrix3d S = Eigen::Matrix3d::Identity();
    S(0, 1) = 0.5;
    EXPECT_FALSE(isPositiveDefinite(S)) << "not symmetric";
    S(0, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(isPositiveDefinite(S)) << "NaN";
    S = Eigen::Vector3d(1, 1, std::numeric_limits<double>::infinity()).asDiagonal();
    EXPECT_FALSE(isPositiveDefinite(S)) << "infinite";
}

TEST(covariance, eigenvalueFloor)
{
    const Eigen::Matrix3d S = Eigen::Vector3d(4, -1, 0).asDiagonal();
    EXPECT_THAT(
        withEigenvalueFloor(S, 0.5),
        IsMatrixNear(Eigen::Matrix3d(Eigen::Vector3d(4, 0.5, 0.5).asDiagonal()), 1e-15));

    GaussianSampler random(33);
    const Matrix6d good = random.covariance<6>(0.1, 1);
    EXPECT_THAT(withEigenvalueFloor(good, 0.01), IsMatrixNear(good, 1e-15)) << "left alone";
    const Matrix6d fixed = withEigenvalueFloor((good - 0.5 * Matrix6d::Identity()).eval(), 1e-9);
    EXPECT_TRUE(isPositiveDefinite(fixed));

    const Eigen::Matrix3d bad = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_THROW((void)withEigenvalueFloor(bad, 1e-9), std::invalid_argument);
}

TEST(covariance, strictlyPositiveLeavesWhatIsAndLiftsWhatDrowns)
{
    Matrix6d S = Matrix6d::Identity();
    EXPECT_THAT(strictlyPositive(S), IsMatrixNear(S, 0)) << "left alone";
    S(0, 0) = 1e6;
    S(5, 5) = 0;
    EXPECT_NEAR(strictlyPositive(S)(5, 5), 1e-6, 1e-8) << "a part of what is known least";
    EXPECT_NEAR(strictlyPositive(Matrix6d::Zero().eval())(2, 2), 1e-14, 1e-20);
}
