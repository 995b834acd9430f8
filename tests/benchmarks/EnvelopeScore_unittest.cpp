// SPDX-License-Identifier: BSD-3-Clause
#include "EnvelopeScore.h"

#include <pointplane/core/se3.h>

#include <cmath>
#include <fstream>

#include "TempDir.h"
#include "envelope_cells.h"
#include "envelope_overview.h"
#include "envelope_tables.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;
using testing::HasSubstr;
using testing::Not;

namespace
{
constexpr double kRadPerDeg = M_PI / 180;
constexpr double kStep = 0.1;  // [s]

Matrix6d covariance(double sigmaTranslation, double sigmaRotation)
{
    Vector6d variances;
    variances.head<3>().setConstant(sigmaTranslation * sigmaTranslation);
    variances.tail<3>().setConstant(sigmaRotation * sigmaRotation);
    return variances.asDiagonal();
}

/** A camera that goes straight on, 0.3 m/s. */
BenchmarkSequence straight(std::size_t numFrames)
{
    BenchmarkSequence out;
    out.name = "straight";
    out.numFrames = numFrames;
    for (std::size_t k = 0; k < numFrames; ++k)
    {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.translation().z() = 0.3 * kStep * static_cast<double>(k);
        out.truth.stamps.push_back(100 + kStep * static_cast<double>(k));
        out.truth.poses.push_back(pose);
    }
    return out;
}

/** What a perfect odometry says of it. */
std::vector<MethodStep> perfect(const BenchmarkSequence& sequence)
{
    std::vector<MethodStep> out;
    for (std::size_t k = 0; k < sequence.numFrames; ++k)
    {
        MethodStep step;
        step.T_prev_cur.translation().z() = k > 0 ? 0.3 * kStep : 0;
        step.incrementCov = covariance(0.002, 0.1 * kRadPerDeg);
        out.push_back(step);
    }
    return out;
}

EnvelopeScore scoreOf(const BenchmarkSequence& sequence, const std::vector<MethodStep>& steps)
{
    EnvelopeScorer scorer(sequence);
    scorer.add(sequence.truth.stamps, steps);
    EnvelopeScore names;
    names.sequence = sequence.name;
    names.condition = "10 Hz";
    names.method = "config.ini";
    return scorer.score(names);
}
}  // namespace

TEST(EnvelopeScore, FiveSigmaHoldsAlongEveryPrincipalAxis)
{
    Vector6d error = Vector6d::Zero();
    error.x() = 0.02;
    EXPECT_TRUE(isBeyondFiveSigma(error, covariance(0.0039, 1)));
    EXPECT_FALSE(isBeyondFiveSigma(error, covariance(0.0041, 1)));
    error.x() = 0.009;  // too small to matter
    EXPECT_FALSE(isBeyondFiveSigma(error, covariance(1e-4, 1)));

    // What is uncertain in one direction does not excuse another one, however they lie.
    const Eigen::Matrix3d R = so3Exp({0.3, -0.5, 0.7});
    Matrix6d cov = covariance(1, 1);
    cov.topLeftCorner<3, 3>() =
        R * Eigen::Vector3d(1, 0.003 * 0.003, 1).asDiagonal() * R.transpose();
    error.head<3>() = R * Eigen::Vector3d(0.5, 0.02, 0);
    EXPECT_TRUE(isBeyondFiveSigma(error, cov));
    error.head<3>() = R * Eigen::Vector3d(0.5, 0.01, 0);
    EXPECT_FALSE(isBeyondFiveSigma(error, cov));

    error.setZero();
    error[4] = 1.1 * kRadPerDeg;
    EXPECT_TRUE(isBeyondFiveSigma(error, covariance(1, 0.2 * kRadPerDeg)));
    EXPECT_FALSE(isBeyondFiveSigma(error, covariance(1, 0.3 * kRadPerDeg)));
}

TEST(EnvelopeScore, APerfectOdometryHasNoErrors)
{
    const BenchmarkSequence sequence = straight(31);
    const EnvelopeScore score = scoreOf(sequence, perfect(sequence));
    EXPECT_EQ(score.numSteps, 30U);
    EXPECT_EQ(score.numTracked, 30U);
    EXPECT_EQ(score.numPairs, 21U);
    EXPECT_NEAR(score.rpeTranslation, 0, 1e-9);
    EXPECT_NEAR(score.worstTranslation, 0, 1e-9);
    EXPECT_TRUE(score.beyond.empty());
    EXPECT_TRUE(score.large.empty());
    EXPECT_NEAR(score.largestSigma, 0.002, 1e-12);
}

TEST(EnvelopeScore, AWrongStepIsFoundWithItsPlace)
{
    const BenchmarkSequence sequence = straight(31);
    std::vector<MethodStep> steps = perfect(sequence);
    steps[12].T_prev_cur.translation().x() = 0.06;
    const EnvelopeScore score = scoreOf(sequence, steps);
    EXPECT_NEAR(score.worstTranslation, 0.06, 1e-9);
    ASSERT_EQ(score.beyond.size(), 1U);
    ASSERT_EQ(score.large.size(), 1U);
    EXPECT_EQ(score.beyond[0].frame, 12U);
    EXPECT_DOUBLE_EQ(score.beyond[0].stamp, sequence.truth.stamps[12]);
    // 10 of the 21 pairs a second apart span it.
    EXPECT_NEAR(score.rpeTranslation, 0.06 * std::sqrt(10.0 / 21), 1e-9);
    EXPECT_NEAR(*score.neesMedian, 0, 1e-9);
    EXPECT_NEAR(*score.nees99, 900.0 / 6, 1e-6);
    EXPECT_THAT(failuresCsv({score}), HasSubstr("straight,10 Hz,config.ini,0,12,101.200000,60.0"));
}

TEST(EnvelopeScore, ACovarianceThatIsNoneCountsAsBeyond)
{
    const BenchmarkSequence sequence = straight(31);
    std::vector<MethodStep> steps = perfect(sequence);
    (*steps[7].incrementCov)(2, 2) = -1e-6;
    (*steps[9].incrementCov)(4, 4) = NAN;
    const EnvelopeScore score = scoreOf(sequence, steps);
    ASSERT_EQ(score.beyond.size(), 2U);
    EXPECT_EQ(score.beyond[0].frame, 7U);
    EXPECT_EQ(score.beyond[1].frame, 9U);
    EXPECT_TRUE(std::isfinite(*score.nees99));
}

TEST(EnvelopeScore, OnlyTrackedStepsAreJudgedAlone)
{
    const BenchmarkSequence sequence = straight(31);
    std::vector<MethodStep> steps = perfect(sequence);
    steps[12].T_prev_cur.translation().x() = 0.06;
    steps[12].outcome = Outcome::Predicted;
    const EnvelopeScore score = scoreOf(sequence, steps);
    EXPECT_EQ(score.numTracked, 29U);
    EXPECT_TRUE(score.beyond.empty());
    EXPECT_NEAR(score.worstTranslation, 0, 1e-9);
    EXPECT_GT(score.rpeTranslation, 0.03);  // the trajectory has the error all the same
}

TEST(EnvelopeScore, NoiseOfTheTruthIsNoErrorOfTheOdometry)
{
    BenchmarkSequence sequence = straight(31);
    std::vector<MethodStep> steps = perfect(sequence);
    steps[12].T_prev_cur.linear() = so3Exp({0, 1.2 * kRadPerDeg, 0});
    EXPECT_EQ(scoreOf(sequence, steps).beyond.size(), 1U);
    sequence.nees.truthSigmaRotation.setConstant(0.3 * kRadPerDeg);
    EXPECT_TRUE(scoreOf(sequence, steps).beyond.empty());
}

TEST(EnvelopeScore, LooseOrMissingTruthDoesNotJudgeCovariances)
{
    BenchmarkSequence sequence = straight(31);
    std::vector<MethodStep> steps = perfect(sequence);
    steps[12].T_prev_cur.translation().x() = 0.06;
    sequence.kind = Truth::Loose;
    const EnvelopeScore loose = scoreOf(sequence, steps);
    EXPECT_TRUE(loose.beyond.empty());
    EXPECT_FALSE(loose.neesMedian);
    EXPECT_GT(loose.rpeTranslation, 0);
    EXPECT_THAT(envelopeTables({loose}), Not(HasSubstr("NEES")));

    sequence.kind = Truth::None;
    const EnvelopeScore none = scoreOf(sequence, steps);
    EXPECT_EQ(none.numPairs, 0U);
    EXPECT_NEAR(none.worstTranslation, std::hypot(0.06, 0.03), 1e-9);  // the step itself
    EXPECT_THAT(envelopeTables({none}), HasSubstr("largest step"));
}

TEST(EnvelopeTables, ScoresOfAnEarlierRunComeBesideTheSameCells)
{
    const BenchmarkSequence sequence = straight(31);
    std::vector<MethodStep> steps = perfect(sequence);
    steps[12].T_prev_cur.translation().x() = 0.06;
    EnvelopeScore peer = scoreOf(sequence, steps);
    peer.method = "peer";
    peer.isPeer = true;
    EnvelopeScore elsewhere = peer;
    elsewhere.condition = "3 Hz";
    const test::TempDir dir;
    std::ofstream(dir / "a.csv") << envelopeCsv({peer, elsewhere});
    const std::vector<EnvelopeScore> read = scoresFromCsv(dir / "a.csv");
    ASSERT_EQ(read.size(), 2U);
    EXPECT_TRUE(read[0].isPeer);
    EXPECT_EQ(read[0].numSteps, 30U);
    EXPECT_EQ(read[0].beyond.size(), 1U);
    EXPECT_NEAR(read[0].rpeTranslation, peer.rpeTranslation, 1e-6);
    EXPECT_NEAR(read[0].worstTranslation, 0.06, 1e-6);

    const EnvelopeScore own = scoreOf(sequence, perfect(sequence));
    const auto both = withMethodsOf({own}, read);
    ASSERT_EQ(both.size(), 2U);
    EXPECT_EQ(both[1].method, "peer");
    EXPECT_EQ(both[1].condition, "10 Hz");
    // What was run again is not taken from the earlier run: it would count twice.
    EXPECT_EQ(withMethodsOf({own}, {own, peer}).size(), 2U);

    std::ofstream(dir / "b.csv") << "header\none,two\n";
    EXPECT_THROW((void)scoresFromCsv(dir / "b.csv"), std::runtime_error);
    EXPECT_THROW((void)scoresFromCsv(dir / "none.csv"), std::runtime_error);
}

TEST(EnvelopeTables, CellsBehindAPeerAreNamed)
{
    const BenchmarkSequence sequence = straight(31);
    std::vector<MethodStep> steps = perfect(sequence);
    EnvelopeScore peer = scoreOf(sequence, steps);
    peer.method = "peer";
    peer.isPeer = true;
    steps[12].T_prev_cur.translation().x() = 0.06;
    const EnvelopeScore own = scoreOf(sequence, steps);
    EXPECT_THAT(
        envelopeSummary({own, peer}),
        HasSubstr("Behind the best peer in 1 of 1 cells:\n\n- straight: 10 Hz\n"));
    EXPECT_THAT(envelopeTables({own, peer}), HasSubstr("| 10 Hz | 30 | 100 |"));
    EXPECT_THAT(envelopeTables({own, peer}), HasSubstr("**1**"));
    peer.rpeTranslation = 1;
    peer.rpeRotation = 1;
    EXPECT_THAT(envelopeSummary({own, peer}), HasSubstr("Behind the best peer in 0 of 1 cells."));
}

/** Without a score, a cell looked as if it had never been run. */
TEST(EnvelopeTables, CellsInWhichWeGaveUpAreSeenAndCountAsBehind)
{
    const BenchmarkSequence sequence = straight(31);
    EnvelopeScore peer = scoreOf(sequence, perfect(sequence));
    peer.method = "peer";
    peer.isPeer = true;
    EXPECT_NO_THROW(requireNoFailures({peer}));
    EnvelopeScore own;
    own.sequence = peer.sequence;
    own.condition = peer.condition;
    own.method = "config.ini";
    own.failure = "no frame";
    EXPECT_THAT(envelopeOverview({own, peer}), HasSubstr("| straight | gave up (0.0) | gave up |"));
    EXPECT_THAT(envelopeTables({own, peer}), HasSubstr("| gave up | gave up |"));
    EXPECT_THAT(
        envelopeSummary({own, peer}),
        testing::AllOf(
            HasSubstr("| config.ini | 0, gave up in 1 cells |"),
            HasSubstr("Behind the best peer in 1 of 1 cells:\n\n- straight: 10 Hz (gave up)\n")));
    EnvelopeScore good = scoreOf(sequence, perfect(sequence));
    good.condition = "3 Hz";
    EXPECT_THAT(
        envelopeOverview({own, peer, good}),
        HasSubstr("| straight | 2, gave up in 1 | 0.0 / 0.00"));
    EXPECT_THROW(requireNoFailures({good, own}), IncompleteError);
    peer.failure = "singular";
    EXPECT_NO_THROW(requireNoFailures({good, peer}));
}

TEST(EnvelopeTables, OverviewHasALinePerSequence)
{
    const BenchmarkSequence sequence = straight(31);
    std::vector<MethodStep> steps = perfect(sequence);
    EnvelopeScore peer = scoreOf(sequence, steps);
    peer.method = "peer";
    peer.isPeer = true;
    peer.rpeTranslation = 0.0123;
    steps[12].T_prev_cur.translation().x() = 0.06;
    EnvelopeScore own = scoreOf(sequence, steps);
    // Under a single condition, sequences are told in full.
    EXPECT_THAT(
        envelopeOverview({own, peer}),
        HasSubstr("| " + own.sequence + " | **" + lengthText(own.rpeTranslation) + "** (12) |"));
    EXPECT_THAT(envelopeSummary({own, peer}), Not(HasSubstr("by condition")));

    own.rpeTranslation = 0.004;
    own.rpeRotation = 0;
    EnvelopeScore slow = own, slower = own;
    slow.condition = "3 Hz";
    slow.beyond.clear();
    slow.rpeTranslation = 0.0045;
    slower.condition = "2 Hz";
    slower.rpeTranslation = 1;
    EXPECT_THAT(envelopeSummary({own, slow}), HasSubstr("by condition"));
    const std::string all = envelopeOverview({own, peer, slow, slower});
    EXPECT_THAT(all, HasSubstr("| straight | 3 | 4.5 / 0.00 | 12 / 0.00 | 2 |"));
    EXPECT_THAT(all, Not(HasSubstr("worst step")));
    slow.rpeTranslation = 0.005;
    EXPECT_THAT(envelopeOverview({own, slow}), HasSubstr("| straight | 2 | 4.5 / 0.00 | 1 |"));

    slow.truth = Truth::None;
    slower.truth = Truth::None;
    slower.numTracked = slower.numSteps / 2;
    EXPECT_THAT(envelopeOverview({slow, slower}), HasSubstr("| straight | 2 | 75 | 50 | 60 |"));
}
