// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/consistency.h>
#include <pointplane/evaluation/nees.h>

#include <cmath>

#include "matchers.h"
#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;
using testing::HasSubstr;

namespace
{
NeesResult neesOf(
    const Trajectory& truth,
    const Trajectory& estimate,
    const std::string& interval,
    const NeesOptions& options = {})
{
    const auto increments =
        neesIncrements(truth, estimate, neesIntervalFromName(interval), options);
    return consistencyOf(increments, countIndependent(increments), neesIntervalFromName(interval));
}

/** Every pose with noise in its own frame. \param sigma [m] \param sigmaRotation [rad] */
Trajectory withNoise(Trajectory truth, double sigma, const Eigen::Vector3d& sigmaRotation)
{
    test::GaussianSampler random(9);
    for (Eigen::Isometry3d& T : truth.poses)
    {
        T.translation() += sigma * random.vector<3>();
        T.linear() = T.linear() * so3Exp(sigmaRotation.cwiseProduct(random.vector<3>()));
    }
    return truth;
}
}  // namespace

TEST(NeesInterval, parsesFramesAndSeconds)
{
    EXPECT_EQ(neesIntervalFromName("10f").delta, 10);
    EXPECT_EQ(neesIntervalFromName("0.5s").unit, DeltaUnit::Seconds);
    EXPECT_EQ(nameOf(neesIntervalFromName("0.5s")), "0.5s");
    for (const char* bad :
         {"", "f", "0f", "1.5f", "99999999999999999999f", "-1s", "1m", "1", "nans", "1ss"})
    {
        EXPECT_THROW((void)neesIntervalFromName(bad), std::invalid_argument) << bad;
    }
}

TEST(Nees, incrementCovarianceComesBackOutOfTheAccumulatedOnes)
{
    const Trajectory truth = randomTrajectory(300, 1);
    const Trajectory estimate = odometry(truth, 2);
    EXPECT_THAT(
        incrementCovariance(estimate, 250, 251),
        test::IsMatrixNear(incrementCov(), 1e-6 * incrementCov().norm()));

    PoseGaussian two{estimate.poses[250].inverse() * estimate.poses[251], incrementCov()};
    two = compose(two, {estimate.poses[251].inverse() * estimate.poses[252], incrementCov()});
    EXPECT_THAT(
        incrementCovariance(estimate, 250, 252),
        test::IsMatrixNear(two.cov, 1e-6 * two.cov.norm()));
}

/** Poses whose errors have something in common tell how uncertain increments are themselves. */
TEST(Nees, incrementCovariancesThatWereToldCountAsTheyAre)
{
    const Trajectory truth = randomTrajectory(300, 1);
    Trajectory estimate = odometry(truth, 2);
    estimate.sinceCovs.resize(300);
    estimate.sinceCovs[250] = {2 * incrementCov(), 3 * incrementCov()};
    EXPECT_EQ(incrementCovariance(estimate, 249, 250), Matrix6d(2 * incrementCov()));
    EXPECT_EQ(incrementCovariance(estimate, 248, 250), Matrix6d(3 * incrementCov()));
    EXPECT_THAT(
        incrementCovariance(estimate, 250, 251),
        test::IsMatrixNear(incrementCov(), 1e-6 * incrementCov().norm()));

    // Another body, turned by T: the same error seen from there.
    const Eigen::Isometry3d T = se3Exp(Vector6d::LinSpaced(-0.5, 1));
    const Matrix6d Ad = adjoint(T.inverse());
    EXPECT_THAT(
        incrementCovariance(withBody(estimate, T), 249, 250),
        test::IsMatrixNear(Matrix6d(Ad * 2 * incrementCov() * Ad.transpose()), 1e-12));
}

TEST(Nees, honestCovariancesAreConsistentAtEveryInterval)
{
    const Trajectory truth = randomTrajectory(3000, 1);
    const Trajectory estimate = odometry(truth, 2);
    for (const char* interval : {"1f", "10f", "1s"})
    {
        const NeesResult r = neesOf(truth, estimate, interval);
        EXPECT_THAT(
            r.joint.nees, testing::AllOf(testing::Gt(r.joint.lower), testing::Lt(r.joint.upper)))
            << interval;
        EXPECT_EQ(verdict(r.joint), "consistent") << interval;
        EXPECT_NEAR(r.translation.nees, 1, 0.15) << interval;
        EXPECT_NEAR(r.rotation.nees, 1, 0.15) << interval;
        for (const AxisConsistency& axis : r.axes)
        {
            EXPECT_NEAR(axis.rmsError / axis.rmsSigma, 1, 0.15) << interval;
        }
    }
}

TEST(Nees, boundsHoldInNineteenOfTwentyRuns)
{
    int outside = 0;
    constexpr int kRuns = 200;
    const Trajectory truth = randomTrajectory(60, 1);
    for (unsigned seed = 0; seed < kRuns; ++seed)
    {
        const NeesResult r = neesOf(truth, odometry(truth, seed), "1f");
        outside += r.joint.isOptimistic() || r.joint.isConservative() ? 1 : 0;
    }
    EXPECT_NEAR(outside, 0.05 * kRuns, 9);  // three sigmas of the binomial
}

TEST(Nees, whatIsNotFiniteIsNotJudged)
{
    for (const double nees : {std::nan(""), HUGE_VAL})
    {
        const ConsistencyTest test{nees, 0.5, 2};
        EXPECT_FALSE(test.isOptimistic() || test.isConservative());
        EXPECT_THAT(verdict(test), testing::StartsWith("cannot be judged: NEES is not finite"));
        EXPECT_EQ(shortVerdict(test), "cannot be judged");
    }
    EXPECT_EQ(shortVerdict({1, 0.5, 2}), "consistent");
}

TEST(Nees, optimismIsFoundAndItsFactorNamed)
{
    const Trajectory truth = randomTrajectory(2000, 3);
    const NeesResult optimistic = neesOf(truth, odometry(truth, 2, 3), "1f");
    EXPECT_NEAR(optimistic.joint.nees, 9, 0.5);
    EXPECT_THAT(
        verdict(optimistic.joint),
        testing::ContainsRegex("too small by a factor of (2\\.9|3\\.0)"));
    const NeesResult conservative = neesOf(truth, odometry(truth, 2, 0.5), "1f");
    EXPECT_THAT(
        verdict(conservative.joint),
        testing::ContainsRegex("too large by a factor of (1\\.9|2\\.0)"));
}

TEST(Nees, anisotropyShowsTheAxisThatIsWrong)
{
    const Trajectory truth = randomTrajectory(2000, 3);
    Vector6d bias = Vector6d::Zero();
    bias.y() = 0.004;  // four sigmas
    const NeesResult r = neesOf(truth, odometry(truth, 2, 1, bias), "1f");
    EXPECT_NEAR(r.whitenedEigenvalues[5], 17, 1.5);
    EXPECT_NEAR(r.whitenedEigenvalues[0], 1, 0.15);
    EXPECT_GT(std::abs(r.mostOptimistic[1]), 0.98);
    EXPECT_NEAR(r.axes[1].meanError, -0.004, 2e-4);  // the estimate errs to +y: truth lies at -y
    EXPECT_TRUE(r.axes[1].test.isOptimistic());
    EXPECT_NEAR(r.axes[2].test.nees, 1, 0.15);
}

/** Rounding left a little less than zero, which was shown as -0.000. */
TEST(Nees, directionsThatFewIncrementsHaveNoErrorInAreNotNegative)
{
    for (unsigned seed = 0; seed < 20; ++seed)
    {
        const Trajectory truth = randomTrajectory(4, seed);
        const NeesResult r = neesOf(truth, odometry(truth, seed), "1f");
        ASSERT_LT(r.increments, 6U);
        EXPECT_GE(r.whitenedEigenvalues.minCoeff(), 0) << seed;
        EXPECT_GT(r.whitenedEigenvalues[5], 0) << seed;
    }
}

TEST(Nees, statedGroundTruthNoiseIsAccountedFor)
{
    const Trajectory exact = randomTrajectory(2000, 3);
    const Trajectory estimate = odometry(exact, 2);
    const Trajectory noisy = withNoise(exact, 0.005, Eigen::Vector3d::Constant(0.003));
    EXPECT_TRUE(neesOf(noisy, estimate, "1f").joint.isOptimistic());
    NeesOptions options;
    options.truthSigmaTranslation = 0.005;
    options.truthSigmaRotation.setConstant(0.003);
    EXPECT_NEAR(neesOf(noisy, estimate, "1f", options).joint.nees, 1, 0.06);
    EXPECT_NEAR(neesOf(noisy, estimate, "10f", options).joint.nees, 1, 0.1);
}

TEST(Nees, groundTruthNoiseMayDifferAboutEachAxis)
{
    const Eigen::Vector3d sigma(0.012, 0.004, 0.0015);
    const Trajectory body = randomTrajectory(2000, 3);
    const Trajectory estimate = odometry(body, 2);
    NeesOptions options;
    options.T_truth_body.linear() = so3Exp({1.2, -1.2, 1.2});  // other axes than the estimate's
    const Trajectory truth = withNoise(withBody(body, options.T_truth_body.inverse()), 0, sigma);
    options.truthSigmaRotation = sigma;
    for (const char* interval : {"1f", "10f"})
    {
        const NeesResult r = neesOf(truth, estimate, interval, options);
        EXPECT_NEAR(r.joint.nees, 1, 0.1) << interval;
        for (const AxisConsistency& axis : r.axes)
        {
            EXPECT_NEAR(axis.test.nees, 1, 0.25) << interval;
        }
    }
    // The same noise spread evenly is too little about one axis, too much about the others.
    options.truthSigmaRotation.setConstant(std::sqrt(sigma.squaredNorm() / 3));
    const NeesResult even = neesOf(truth, estimate, "1f", options);
    EXPECT_GT(even.whitenedEigenvalues[5], 2);
    EXPECT_LT(even.whitenedEigenvalues[0], 0.5);
}

TEST(Nees, bodyFramesOfTruthAndEstimateMayDiffer)
{
    Vector6d xi;
    xi << 0.1, -0.2, 0.3, -0.5, 1.2, 0.4;
    const Eigen::Isometry3d T_truth_body = se3Exp(xi);
    const Trajectory body = randomTrajectory(500, 3);
    const Trajectory estimate = odometry(body, 2);
    const Trajectory truth = withBody(body, T_truth_body.inverse());
    NeesOptions options;
    options.T_truth_body = T_truth_body;
    EXPECT_NEAR(
        neesOf(truth, estimate, "1f", options).joint.nees,
        neesOf(body, estimate, "1f").joint.nees,
        1e-6);

    // Noise of the truth's body moves the estimate's body by the lever arm too.
    const Trajectory noisy = withNoise(truth, 0, Eigen::Vector3d::Constant(0.01));
    options.truthSigmaRotation.setConstant(0.01);
    EXPECT_NEAR(neesOf(noisy, estimate, "1f", options).joint.nees, 1, 0.12);
}

TEST(Nees, refusesWhatCannotBeTested)
{
    const Trajectory truth = randomTrajectory(50, 3);
    EXPECT_THROW((void)neesOf(truth, truth, "1f"), std::runtime_error);  // no covariances
    const Trajectory estimate = odometry(truth, 2);
    EXPECT_THROW((void)neesOf(truth, estimate, "60f"), std::runtime_error);
    Trajectory constant = estimate;
    constant.covs.assign(50, incrementCov());  // does not accumulate: the difference is zero
    try
    {
        (void)neesOf(truth, constant, "1f");
        FAIL() << "no exception";
    }
    catch (const UntoldCovariance& e)
    {
        EXPECT_THAT(e.what(), HasSubstr("100.000000 to 100.100000 s is not positive definite"));
    }
}

TEST(Nees, posesSinceTheFirstAreOneIncrementThatGrows)
{
    const Trajectory truth = randomTrajectory(300, 1);
    const Trajectory estimate = odometry(truth, 2);
    const NeesInterval start = neesIntervalFromName("start");
    EXPECT_EQ(nameOf(start), "start");
    const auto increments = neesIncrements(truth, estimate, start, {});
    ASSERT_EQ(increments.size(), 299u);
    EXPECT_EQ(increments[7].i, 0u);
    EXPECT_EQ(increments[7].j, 8u);
    EXPECT_EQ(countIndependent(increments), 1u);
    EXPECT_EQ(neesRun(truth, estimate, {start}, {}).note, "") << "the first pose is certain";
    EXPECT_THAT(
        neesRun(truth, estimate, {neesIntervalFromName("1f")}, {}).note, HasSubstr("--since"));
    const Matrix6d Ad = adjoint(estimate.poses[0].inverse());
    const Matrix6d expected = Ad * estimate.covs[8] * Ad.transpose();
    EXPECT_THAT(increments[7].cov, test::IsMatrixNear(expected, 1e-6 * expected.norm()));
}
