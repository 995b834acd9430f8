// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/ErrorModel.h"

#include <cmath>

#include "matchers.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Features as noisy as propagated, and a camera that has moved by one view since its only
 * reference.
 */
class ErrorModelTest : public testing::Test
{
 protected:
    ErrorModelTest()
    {
        params.noiseScale.adaptive = false;
        reference.id = 1;
        estimate.motion.mean.T_prev_cur.translation().x() = 0.15;
        estimate.infoPoints = Matrix6d::Identity();
        estimate.infoPoints.bottomRightCorner<3, 3>() *= 2;  // as if they were 1 m away
        analysis.sensitivity.points = Matrix12d::Identity();
        analysis.sensitivity.planes = 2 * Matrix12d::Identity();
        analysis.pointVariance = analysis.planeVariance = 1;
    }

    [[nodiscard]] JointCovariance::Measurement learn() const
    {
        ErrorModel model(params);
        return model.learn({{&reference}, estimate, analysis, 1e-9, Matrix12d::Zero()});
    }

    OdometryParams params;
    Reference reference;
    PoseEstimate estimate;
    PoseAnalysis analysis;
};
}  // namespace

TEST_F(ErrorModelTest, aFrameWithLargerResidualsThanUsualIsNoisier)
{
    const double usual = learn().noise(0, 0);
    analysis.pointVariance = analysis.planeVariance = 10;
    EXPECT_NEAR(learn().noise(0, 0), 10 * usual, 1e-9 * usual);
    analysis.planeVariance = 0.1;
    EXPECT_LT(learn().noise(0, 0), 10 * usual);
    analysis.pointVariance = 0.1;
    EXPECT_NEAR(learn().noise(0, 0), usual, 1e-9 * usual) << "one quiet frame proves nothing";
}

TEST_F(ErrorModelTest, aReferenceDriftsAsTheViewChanges)
{
    const JointCovariance::Measurement out = learn();
    const JointCovariance::DriftStep& step = out.steps.at(1);
    EXPECT_NEAR(step.gained, 4 * (1 - std::exp(-0.25)), 1e-6);
    EXPECT_NEAR(step.whole, step.gained, 1e-12) << "the frame before is the reference itself";
    EXPECT_GT(out.drift(0, 0), 0);
    EXPECT_NEAR(out.drift(3, 3), out.drift(0, 0) / 4, 1e-12)
        << "a turn errs by half of it, 1 m away";
    params.covariance.driftSigma *= 2;
    EXPECT_NEAR(learn().drift(0, 0), 4 * out.drift(0, 0), 1e-15);
}

/** Points and planes that a frame does not have say nothing of what it errs by. */
TEST_F(ErrorModelTest, onlyTheKindsThatAFrameHasCount)
{
    analysis.sensitivity.planes.setZero();
    const double points = learn().drift(0, 0);
    analysis.sensitivity.planes = analysis.sensitivity.points;
    const double both = learn().drift(0, 0);
    analysis.sensitivity.points.setZero();
    const double planes = learn().drift(0, 0);
    EXPECT_NEAR(both, std::sqrt(points * planes), 1e-15);
}

TEST_F(ErrorModelTest, aFrameErrsByAccelerationWhileItIsExposed)
{
    analysis.sensitivity.planesMoved.topRows<6>().setIdentity();
    const auto noise = [&](double depthDelay)
    {
        ErrorModel model(params);
        return model
            .learn(
                {{&reference},
                 estimate,
                 analysis,
                 1e-9,
                 Matrix12d::Zero(),
                 4 * Vector6d::Ones(),
                 {0, 0, depthDelay}})
            .noise(0, 0);
    };
    EXPECT_NEAR(noise(0.02) - noise(0), 0.0004 * 0.0004, 1e-13);
}

TEST_F(ErrorModelTest, independentIncrementsErrAsTheSolverSays)
{
    params.covariance.model = "independent";
    estimate.motion.cov = 3 * Matrix12d::Identity();
    const JointCovariance::Measurement out = learn();
    EXPECT_THAT(
        Matrix6d(out.noise.topLeftCorner<6, 6>()),
        test::IsMatrixNear(Matrix6d(3 * Matrix6d::Identity()), 1e-15));
    EXPECT_TRUE(out.references.empty());
    EXPECT_TRUE(out.drift.isZero(0));
}
}  // namespace pointplane
