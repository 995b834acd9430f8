// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/compare.h>

#include <cmath>

#include "test_trajectories.h"
#include <gtest/gtest.h>

using namespace pointplane;

namespace
{
RpeOptions overOneSecond()
{
    RpeOptions options;
    options.fixedDelta = true;
    return options;
}
}  // namespace

TEST(Bootstrap, intervalOfIndependentErrorsMatchesTheory)
{
    // x^2 of N(0,1) has mean 1 and variance 2: RMSE has a standard error of sqrt(2/n)/2.
    test::GaussianSampler random(1);
    std::vector<double> errors;
    for (int k = 0; k < 5000; ++k)
    {
        errors.push_back(std::abs(random.normal()));
    }
    const BootstrapInterval r = bootstrapRmse(errors, {});
    const double expected = 1.96 * std::sqrt(2.0 / 5000) / 2;
    EXPECT_NEAR(r.value, 1, 0.04);
    EXPECT_NEAR(r.upper - r.value, expected, 0.15 * expected);
    EXPECT_NEAR(r.value - r.lower, expected, 0.15 * expected);
}

TEST(Bootstrap, blocksWidenTheIntervalOfCorrelatedErrors)
{
    test::GaussianSampler random(1);
    std::vector<double> errors;
    double e = 1;
    for (int k = 0; k < 3000; ++k)
    {
        if (k % 30 == 0)
        {
            e = 1 + 0.3 * random.normal();
        }
        errors.push_back(std::abs(e));  // 100 independent values, 30 times each
    }
    BootstrapOptions single;
    BootstrapOptions blocks;
    blocks.blockLength = 30;
    const BootstrapInterval narrow = bootstrapRmse(errors, single);
    const BootstrapInterval wide = bootstrapRmse(errors, blocks);
    const double ratio = (wide.upper - wide.lower) / (narrow.upper - narrow.lower);
    EXPECT_GT(ratio, 3);  // theory: about sqrt(30 * 2/3), as blocks straddle two values
    EXPECT_LT(ratio, 6);
}

TEST(Bootstrap, pairedDifferenceCancelsWhatIsCommon)
{
    test::GaussianSampler random(4);
    std::vector<double> a;
    std::vector<double> b;
    for (int k = 0; k < 500; ++k)
    {
        const double common = std::exp(random.normal());
        a.push_back(common * 1.02);
        b.push_back(common);
    }
    const BootstrapInterval difference = bootstrapRmseDifference(a, b, {});
    EXPECT_TRUE(difference.excludesZero());
    EXPECT_GT(difference.lower, 0);
    EXPECT_FALSE(bootstrapRmseDifference(a, a, {}).excludesZero());
    EXPECT_THROW((void)bootstrapRmseDifference(a, {1, 2}, {}), std::invalid_argument);
    EXPECT_THROW((void)bootstrapRmse({1}, {}), std::invalid_argument);
}

TEST(Bootstrap, isRepeatable)
{
    const std::vector<double> errors{1, 2, 3, 4, 5, 6, 7};
    BootstrapOptions options;
    EXPECT_EQ(bootstrapRmse(errors, options).lower, bootstrapRmse(errors, options).lower);
    options.blockLength = 100;  // longer than the data: clamped
    EXPECT_EQ(bootstrapRmse(errors, options).lower, bootstrapRmse(errors, options).value);
}

TEST(Compare, findsTheBestAndHowSureThatIs)
{
    const Trajectory truth = randomTrajectory(400, 1);
    const std::vector<Trajectory> runs{
        perturbed(truth, 0.02, 2), perturbed(truth, 0.01, 3), perturbed(truth, 0.01, 4)};
    const Comparison c = compareRuns(truth, runs, overOneSecond(), {}, {});
    const std::size_t best = c.bestTranslation;
    const std::size_t equal = best == 1 ? 2 : 1;  // as noisy, with other noise
    EXPECT_NE(best, 0u);
    ASSERT_TRUE(c.bestAte.has_value());
    EXPECT_NE(*c.bestAte, 0u);
    ASSERT_TRUE(c.runs[0].translationBehindBest.has_value());
    EXPECT_TRUE(c.runs[0].translationBehindBest->excludesZero());
    EXPECT_NEAR(
        c.runs[0].translationBehindBest->value,
        c.runs[0].translation.value - c.runs[best].translation.value,
        1e-12);
    EXPECT_FALSE(c.runs[best].translationBehindBest.has_value());
    EXPECT_FALSE(c.runs[equal].translationBehindBest->excludesZero());
    EXPECT_EQ(c.runs[0].pairsInCommon, c.runs[0].rpe.pairs.size());
}

TEST(Compare, whoGivesUpBeforeTheHardPartIsNotTheBest)
{
    const Trajectory truth = randomTrajectory(400, 1);
    Trajectory whole = perturbed(truth, 0.01, 2);
    const Trajectory hard = perturbed(truth, 0.2, 3);
    std::copy(hard.poses.begin() + 200, hard.poses.end(), whole.poses.begin() + 200);
    Trajectory half = perturbed(truth, 0.03, 4);
    half.stamps.resize(200);
    half.poses.resize(200);
    const Comparison c = compareRuns(truth, {half, whole}, overOneSecond(), {}, {});
    EXPECT_EQ(c.bestTranslation, 1u);
    EXPECT_LT(c.runs[1].translation.value, 0.5 * c.runs[0].translation.value);
    EXPECT_GT(c.runs[0].translationBehindBest->lower, 0);
    EXPECT_TRUE(compareRuns(truth, {whole, whole}, overOneSecond(), {}, {}).sameFrames);
    EXPECT_FALSE(c.bestAte.has_value());  // each run's ATE is of its own frames
}

TEST(Compare, onlyPairsThatBothRunsHaveCount)
{
    const Trajectory truth = randomTrajectory(200, 1);
    Trajectory half = perturbed(truth, 0.02, 2);
    half.stamps.resize(100);
    half.poses.resize(100);
    const std::vector<Trajectory> runs{half, perturbed(truth, 0.01, 3)};
    const Comparison c = compareRuns(truth, runs, overOneSecond(), {}, {});
    EXPECT_EQ(c.runs[0].pairsInCommon, c.runs[0].rpe.pairs.size());
    EXPECT_LT(c.runs[0].pairsInCommon, c.runs[1].rpe.pairs.size());

    EXPECT_FALSE(c.sameFrames);
    EXPECT_EQ(c.numCommonPairs, c.runs[0].pairsInCommon);

    Trajectory shifted = perturbed(truth, 0.05, 2);
    for (double& stamp : shifted.stamps)
    {
        stamp += 0.001;
    }
    const Comparison none = compareRuns(truth, {shifted, runs[1]}, overOneSecond(), {}, {});
    EXPECT_EQ(none.runs[0].pairsInCommon, 0u);
    EXPECT_FALSE(none.runs[0].translationBehindBest.has_value());
    EXPECT_FALSE(none.isComparable());
    EXPECT_TRUE(c.isComparable());
    EXPECT_THROW((void)compareRuns(truth, runs, {}, {}, {}), std::invalid_argument);
}
