// SPDX-License-Identifier: BSD-3-Clause
#include "PoseHistory.h"

#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>

#include "linear_algebra.h"
#include "matchers.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** A frame later, with a velocity that stays. */
const DecayedVelocities kFrame{{1.0 / 30, 1, 0, 0, 0}, {1.0 / 30, 1, 0, 0, 0}};

/** A rotation by 20 degrees about the diagonal, 10 m from the origin. */
Eigen::Isometry3d elsewhere()
{
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = so3Exp(0.2 * Eigen::Vector3d::Ones());
    out.translation() << 10, -3, 5;
    return out;
}

void expectPositiveDefinite(const Matrix6d& cov)
{
    EXPECT_EQ(cov, Matrix6d(cov.transpose()));
    EXPECT_TRUE(test::hasCholesky(cov)) << cov;
}
}  // namespace

TEST(PoseHistory, beginsAtTheFirstFrame)
{
    PoseHistory history(10);
    PoseGaussian first;
    first.cov = 1e-6 * Matrix6d::Identity();
    history.predict(first);
    EXPECT_EQ(history.latestFrame(), 1);
    EXPECT_TRUE(history.sinceAll().empty());
    EXPECT_THAT(history.pose().mean, test::IsNearPose(Eigen::Isometry3d::Identity(), 0, 0));
    EXPECT_THAT(history.pose().cov, test::IsMatrixNear(first.cov, 1e-15));
}

TEST(PoseHistory, tellsPredictedMotionsAsComposed)
{
    PoseHistory history(10);
    history.predict({});
    PoseGaussian step;
    step.mean.translation().x() = 0.1;
    step.cov = 1e-4 * Matrix6d::Identity();
    history.predict(step);
    history.predict(step);
    const std::vector<PoseGaussian> since = history.sinceAll();
    ASSERT_EQ(since.size(), 2U);
    EXPECT_THAT(since[0].cov, test::IsMatrixNear(step.cov, 1e-12));
    EXPECT_NEAR(since[1].mean.translation().x(), 0.2, 1e-12);
    const Matrix6d composed = step.cov + propagate(adjoint(step.mean), step.cov);
    EXPECT_THAT(since[1].cov, test::IsMatrixNear(composed, 1e-12));
    EXPECT_THAT(history.pose().cov, test::IsMatrixNear(composed, 1e-9));
}

/** Directions known to a micrometre beside ones unknown by hundreds of metres: rounding of the
 * large ones must not show as negative variances of the small ones. */
TEST(PoseHistory, covariancesStayPositiveDefiniteWhereNothingIsKnown)
{
    PoseHistory history(10);
    history.predict({});
    history.restart(1);
    JointCovariance::Measurement measurement;
    Vector6d variances;
    variances << 1e4, 1e-12, 1e4, 1e-14, 1e2, 1e-14;
    const Matrix6d cov = propagate(adjoint(elsewhere()), Matrix6d(variances.asDiagonal()));
    measurement.noise.topLeftCorner<6, 6>() = cov;
    measurement.views.pointSigma.head<6>() = 0.03 * variances.cwiseSqrt();
    for (int frame = 2; frame <= 40; ++frame)
    {
        measurement.factors.references.clear();
        measurement.factors.references[1].setZero();
        measurement.factors.references[1].topLeftCorner<6, 6>().setIdentity();
        measurement.factors.referencePoints = measurement.factors.references;
        history.measure(history.latest(), elsewhere(), kFrame, measurement, {});
        history.keep({1}, {});
        expectPositiveDefinite(history.pose().cov);
        for (const PoseGaussian& motion : history.sinceAll())
        {
            expectPositiveDefinite(motion.cov);
        }
    }
}
}  // namespace pointplane
