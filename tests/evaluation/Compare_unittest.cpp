// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/compare.h>

#include <cmath>
#include <iostream>

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
    EXPECT_EQ(bootstrapRmse(errors, {}).lower, bootstrapRmse(errors, {}).lower);
}

/** Blocks hardly differ then: an interval of no width would not hold zero, whatever the runs. */
TEST(Bootstrap, fewerThanFourBlocksHaveNoInterval)
{
    const std::vector<double> a{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    const std::vector<double> b{2, 2, 3, 3, 6, 6, 7, 8, 9, 10, 11, 11};
    for (const std::size_t length : {1, 3, 4, 8, 12, 100})
    {
        BootstrapOptions options;
        options.blockLength = length;
        for (const BootstrapInterval& r :
             {bootstrapRmse(a, options), bootstrapRmseDifference(a, b, options)})
        {
            EXPECT_EQ(r.independent, 12 / std::min<std::size_t>(length, 12));
            EXPECT_EQ(r.isKnown(), length <= 3);
            EXPECT_EQ(std::isnan(r.lower) && std::isnan(r.upper), length > 3);
            EXPECT_TRUE(r.isKnown() || !r.excludesZero());
        }
    }
}

/** Of two runs that are equally good, so many intervals of the difference should hold zero. */
TEST(Bootstrap, intervalsOfFewBlocksHoldTheTruth)
{
    constexpr std::size_t kLength = 10;
    constexpr int kRuns = 300;
    test::GaussianSampler random(7);
    const auto overlapping = [&](std::size_t n)
    {
        std::vector<double> walk{0};
        for (std::size_t k = 0; k < n + kLength; ++k)
        {
            walk.push_back(walk.back() + random.normal());
        }
        std::vector<double> out;
        for (std::size_t k = 0; k < n; ++k)
        {
            out.push_back(std::abs(walk[k + kLength] - walk[k]));
        }
        return out;
    };
    BootstrapOptions options;
    options.blockLength = kLength;
    options.resamples = 300;
    for (const std::size_t blocks : {4, 8, 16})
    {
        int held = 0;
        for (int run = 0; run < kRuns; ++run)
        {
            const std::vector<double> a = overlapping(blocks * kLength);
            const std::vector<double> b = overlapping(blocks * kLength);
            held += bootstrapRmseDifference(a, b, options).excludesZero() ? 0 : 1;
        }
        std::cout << blocks << " blocks: " << 100 * held / kRuns << " %\n";
        EXPECT_GT(held, 0.86 * kRuns) << blocks;  // 70 to 80 % without Student's t
    }
}

/** Blocks that end with the data draw the first and the last errors the least. */
TEST(Bootstrap, anIntervalHoldsItsValueWhereverErrorsAreLarge)
{
    for (const std::size_t n : {120, 135, 159, 200})
    {
        for (std::size_t peak = 0; peak < n; peak += 9)
        {
            std::vector<double> errors(n, 0.01);
            const std::vector<double> even = errors;
            for (std::size_t k = 0; k < 10; ++k)
            {
                errors[(peak + k) % n] = 1;
            }
            BootstrapOptions options;
            options.blockLength = 30;
            options.resamples = 500;
            for (const BootstrapInterval& r :
                 {bootstrapRmse(errors, options), bootstrapRmseDifference(errors, even, options)})
            {
                EXPECT_LE(r.lower, r.value) << n << " " << peak;
                EXPECT_LE(r.value, r.upper) << n << " " << peak;
                EXPECT_GT(r.upper - r.lower, 0.01) << n << " " << peak;
            }
        }
    }
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
    EXPECT_EQ(c.numCommonPairs, c.runs[0].rpe.pairs.size());
}

TEST(Compare, ofRunsThatAreTooShortItDoesNotTellHowSureItIs)
{
    const Trajectory truth = randomTrajectory(25, 1);  // 10 Hz: pairs of 1 s overlap
    const Comparison c = compareRuns(
        truth, {perturbed(truth, 0.02, 2), perturbed(truth, 0.01, 3)}, overOneSecond(), {}, {});
    const BootstrapInterval& behind = *c.runs[1 - c.bestTranslation].translationBehindBest;
    EXPECT_FALSE(behind.isKnown());
    EXPECT_EQ(behind.independent, 1u);
    EXPECT_FALSE(behind.excludesZero());
    EXPECT_GT(behind.value, 0);
}

TEST(Compare, oneRunIsNotTheBest)
{
    const Trajectory truth = randomTrajectory(100, 1);
    const Comparison c = compareRuns(truth, {perturbed(truth, 0.02, 2)}, overOneSecond(), {}, {});
    EXPECT_FALSE(c.isComparable());
    EXPECT_FALSE(c.bestAte.has_value());
}

/** Few of the pairs that overlap are drawn: blocks are of fewer pairs. */
TEST(Compare, pairsThatWereDrawnAreInShorterBlocks)
{
    const Trajectory truth = randomTrajectory(400, 1);
    RpeOptions drawn = overOneSecond();
    drawn.maxPairs = 39;
    const Comparison c = compareRuns(truth, {perturbed(truth, 0.02, 2)}, drawn, {}, {});
    EXPECT_EQ(c.numCommonPairs, 39u);
    EXPECT_NEAR(static_cast<double>(c.runs[0].translation.independent), 39, 20);
    EXPECT_TRUE(c.runs[0].translation.isKnown());
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
    EXPECT_EQ(c.numCommonPairs, c.runs[0].rpe.pairs.size());
    EXPECT_LT(c.numCommonPairs, c.runs[1].rpe.pairs.size());
    EXPECT_FALSE(c.sameFrames);

    // Among three, too: the distance to the best is that of the two errors beside it.
    const Comparison three =
        compareRuns(truth, {half, runs[1], perturbed(truth, 0.04, 4)}, overOneSecond(), {}, {});
    ASSERT_EQ(three.bestTranslation, 1u);
    EXPECT_EQ(three.numCommonPairs, c.numCommonPairs);
    EXPECT_NEAR(
        three.runs[2].translationBehindBest->value,
        three.runs[2].translation.value - three.runs[1].translation.value,
        1e-12);

    Trajectory shifted = perturbed(truth, 0.05, 2);
    for (double& stamp : shifted.stamps)
    {
        stamp += 0.001;
    }
    const Comparison none = compareRuns(truth, {shifted, runs[1]}, overOneSecond(), {}, {});
    EXPECT_EQ(none.numCommonPairs, 0u);
    EXPECT_FALSE(none.runs[0].translationBehindBest.has_value());
    EXPECT_FALSE(none.isComparable());
    EXPECT_TRUE(c.isComparable());
    EXPECT_THROW((void)compareRuns(truth, runs, {}, {}, {}), std::invalid_argument);
}

/** Programs write stamps with four to nine digits. */
TEST(CompareRuns, framesAreTheSameIfTheirStampsDifferByRoundingOnly)
{
    const Trajectory truth = randomTrajectory(300, 1, 1. / 30);
    const Trajectory exact = perturbed(truth, 0.001, 2);
    Trajectory rounded = perturbed(truth, 0.002, 3);
    for (double& stamp : rounded.stamps)
    {
        stamp = std::round(1e4 * stamp) / 1e4;
    }
    const Comparison c = compareRuns(truth, {exact, rounded}, overOneSecond(), {}, {});
    EXPECT_TRUE(c.sameFrames);
    EXPECT_EQ(c.numCommonPairs, c.runs[0].rpe.pairs.size());
    EXPECT_EQ(c.bestAte, 0u);
    EXPECT_TRUE(c.runs[1].translationBehindBest->excludesZero());

    for (double& stamp : rounded.stamps)
    {
        stamp += 0.01;  // frames between the others
    }
    EXPECT_EQ(compareRuns(truth, {exact, rounded}, overOneSecond(), {}, {}).numCommonPairs, 0u);
}
