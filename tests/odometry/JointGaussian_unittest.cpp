// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/JointGaussian.h"

#include <pointplane/pose/pairs.h>

#include <stdexcept>

#include "matchers.h"
#include "monte_carlo.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using Kind = JointGaussian::Kind;

/** Pose 7 and velocity 7. */
class JointGaussianTest : public testing::Test
{
 protected:
    JointGaussianTest() : cov(test::GaussianSampler(1).covariance<12>(0.1, 1))
    {
        errors.start({{Kind::Pose, 7}, {Kind::Velocity, 7}}, cov);
    }
    Matrix12d cov;
    JointGaussian errors;
};
}  // namespace

TEST_F(JointGaussianTest, blocksHaveTheirSizes)
{
    EXPECT_EQ((JointGaussian::Block{Kind::Pose, 1}.size()), 6);
    EXPECT_EQ((JointGaussian::Block{Kind::View, 1}.size()), 12);
    EXPECT_EQ((JointGaussian::Block{Kind::Camera, 0}.size()), kNumCameraErrors);
    EXPECT_EQ((JointGaussian::Block{Kind::Bend, 1}.size()), kNumPatches);
}

TEST_F(JointGaussianTest, findsBlocksByKindAndFrame)
{
    EXPECT_EQ(errors.find(Kind::Velocity, 7), 6);
    EXPECT_FALSE(errors.has(Kind::Velocity, 8));
    EXPECT_THROW((void)errors.find(Kind::Velocity, 8), std::invalid_argument);
    errors.rename(Kind::Velocity, 7, 8);
    EXPECT_EQ(errors.find(Kind::Velocity, 8), 6);
    EXPECT_TRUE(errors.has(Kind::Pose, 7));
}

/** x' = A x + noise, beside x. */
TEST_F(JointGaussianTest, newBlocksDependOnTheOthers)
{
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(6, 12);
    const Matrix6d Q = 2 * Matrix6d::Identity();
    errors.prepend({{Kind::Pose, 8}}, A, Q);
    EXPECT_EQ(errors.find(Kind::Pose, 7), 6);
    const Eigen::MatrixXd& all = errors.cov();
    EXPECT_TRUE(all.topLeftCorner(6, 6).isApprox(A * cov * A.transpose() + Q, 1e-12));
    EXPECT_TRUE(all.topRightCorner(6, 12).isApprox(A * cov, 1e-12));
    EXPECT_TRUE(all.bottomRightCorner(12, 12).isApprox(cov, 1e-12));
}

TEST_F(JointGaussianTest, aBlockIsReplacedByWhatDependsOnAll)
{
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(6, 12);
    Matrix12d change = Matrix12d::Identity();
    change.bottomRows<6>() = A;
    errors.replace(Kind::Velocity, 7, A);
    EXPECT_TRUE(errors.cov().isApprox(change * cov * change.transpose(), 1e-12));
}

TEST_F(JointGaussianTest, anIndependentBlockHasNothingToDoWithTheOthers)
{
    errors.makeIndependent(Kind::Pose, 7, 3 * Matrix6d::Identity());
    EXPECT_TRUE(errors.cov().topLeftCorner(6, 6).isApprox(3 * Matrix6d::Identity()));
    EXPECT_TRUE(errors.cov().topRightCorner(6, 6).isZero(0));
    EXPECT_EQ(errors.cov().bottomRightCorner(6, 6), cov.bottomRightCorner(6, 6));
}

TEST_F(JointGaussianTest, whatIsForgottenLeavesTheRestAsItIs)
{
    errors.keepIf([](const JointGaussian::Block& block) { return block.kind == Kind::Velocity; });
    ASSERT_EQ(errors.blocks().size(), 1U);
    EXPECT_EQ(errors.find(Kind::Velocity, 7), 0);
    EXPECT_EQ(errors.cov(), cov.bottomRightCorner(6, 6));
}
}  // namespace pointplane
