// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/rpe.h>
#include <pointplane/evaluation/trajectory_text.h>

#include <cmath>

#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;
using testing::HasSubstr;

namespace
{
constexpr double kDeg = 180 / M_PI;

/** The script's line, as it stands there. */
Eigen::Isometry3d scriptError(
    const Trajectory& gt, const Trajectory& est, std::size_t i, std::size_t j, double scale)
{
    Eigen::Isometry3d P = est.poses[j].inverse() * est.poses[i];
    P.translation() *= scale;
    return P.inverse() * (gt.poses[j].inverse() * gt.poses[i]);
}

/** n poses along x with a heading about z, at unit intervals. */
Trajectory line(const std::vector<double>& x, double stampOffset = 0)
{
    std::vector<StampedPose> poses;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        poses.push_back({static_cast<double>(i) + stampOffset, {}, {}});
        poses.back().pose = Eigen::Translation3d(x[i], 0, 0);
    }
    return makeTrajectory("line", poses);
}

/** What RPE says of trajectories that it cannot score. */
std::string refusalOf(
    const Trajectory& truth, const Trajectory& estimate, const RpeOptions& options)
{
    try
    {
        (void)relativePoseError(truth, estimate, options);
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
    return "";
}
}  // namespace

struct GoldenCase
{
    const char* sequence;
    std::size_t pairs;
    const char* translation;
    const char* rotation;
    friend void PrintTo(const GoldenCase& c, std::ostream* out) { *out << c.sequence; }
};

class RpeGolden : public testing::TestWithParam<GoldenCase>
{
};

TEST_P(RpeGolden, matchesEvaluateRpeDigitForDigit)
{
    if (goldenDirectory().empty())
    {
        GTEST_SKIP() << "POINTPLANE_DATA is not set";
    }
    const std::string base = goldenDirectory() + "/" + GetParam().sequence;
    RpeOptions options;
    options.fixedDelta = true;
    const RpeResult r = relativePoseError(
        readTrajectoryText(base + "_groundtruth.txt"),
        readTrajectoryText(base + "_estimate.txt"),
        options);
    char translation[32];
    char rotation[32];
    std::snprintf(translation, sizeof translation, "%.6f", r.translation.rmse);
    std::snprintf(rotation, sizeof rotation, "%.6f", r.rotation.rmse * kDeg);
    EXPECT_EQ(r.translation.count, GetParam().pairs);
    EXPECT_STREQ(translation, GetParam().translation);
    EXPECT_STREQ(rotation, GetParam().rotation);
}

INSTANTIATE_TEST_SUITE_P(
    Tum,
    RpeGolden,
    testing::Values(
        GoldenCase{"fr1_360", 716, "0.088942", "3.415249"},
        GoldenCase{"fr1_desk", 542, "0.033252", "1.599193"},
        GoldenCase{"fr1_desk2", 575, "0.054410", "2.622562"},
        GoldenCase{"fr1_room", 1301, "0.095368", "3.156646"},
        GoldenCase{"fr1_xyz", 753, "0.021217", "0.934480"},
        GoldenCase{"fr1_rpy", 649, "0.045952", "2.735805"}),
    [](const auto& testCase) { return testCase.param.sequence; });

TEST(Rpe, handValueOfADrift)
{
    RpeOptions options;
    options.fixedDelta = true;
    options.delta = 2;
    // 10 % too long: every 2 s interval of 2 m is wrong by 0.2 m.
    const RpeResult r = relativePoseError(
        line({0, 1, 2, 3, 4, 5}),
        line({0, 1.1, 2.2, 3.3, 4.4, 5.5}),
        [&]
        {
            options.delta = 2;
            return options;
        }());
    EXPECT_EQ(r.translation.count, 3u);  // the pair that ends at the last pose is dropped
    EXPECT_NEAR(r.translation.rmse, 0.2, 1e-12);
    EXPECT_NEAR(r.translation.std, 0, 1e-12);
    EXPECT_EQ(r.rotation.max, 0);
    options.scale = 1 / 1.1;
    EXPECT_NEAR(
        relativePoseError(line({0, 1, 2, 3, 4}), line({0, 1.1, 2.2, 3.3, 4.4}), options)
            .translation.max,
        0,
        1e-12);
}

TEST(Rpe, identicalTrajectoriesAndRigidlyMovedOnesHaveNoError)
{
    const Trajectory truth = randomTrajectory(80, 5);
    Trajectory moved = truth;
    Vector6d xi;
    xi << 3, -2, 1, 0.5, -0.7, 1.1;
    for (Eigen::Isometry3d& T : moved.poses)
    {
        T = se3Exp(xi) * T;
    }
    RpeOptions options;
    options.fixedDelta = true;
    const RpeResult r = relativePoseError(truth, moved, options);
    EXPECT_LT(r.translation.max, 1e-12);
    EXPECT_LT(r.rotation.max, 1e-7);  // arccos near 1
}

TEST(Rpe, allPairsAreThoseOfTheScript)
{
    const Trajectory truth = randomTrajectory(40, 1);
    const Trajectory estimate = perturbed(truth, 0.02, 2);
    for (const double scale : {1.0, 1.3})
    {
        RpeOptions options;
        options.scale = scale;
        const RpeResult r = relativePoseError(truth, estimate, options);
        std::vector<double> translations;
        std::vector<double> rotations;
        for (std::size_t i = 0; i < 40; ++i)
        {
            for (std::size_t j = 0; j < 40; ++j)
            {
                const Eigen::Isometry3d E = scriptError(truth, estimate, i, j, scale);
                translations.push_back(E.translation().norm());
                rotations.push_back(rotationAngle(E.linear()));
            }
        }
        const Statistics t = statisticsOf(translations);
        const Statistics w = statisticsOf(rotations);
        EXPECT_EQ(r.translation.count, 1600u);
        EXPECT_NEAR(r.translation.rmse, t.rmse, 1e-12);
        EXPECT_NEAR(r.translation.median, t.median, 1e-12);
        EXPECT_NEAR(r.translation.std, t.std, 1e-12);
        EXPECT_NEAR(r.translation.max, t.max, 1e-12);
        EXPECT_NEAR(r.rotation.rmse, w.rmse, 1e-9);
        EXPECT_NEAR(r.rotation.mean, w.mean, 1e-9);
    }
}

TEST(Rpe, evoFormulaIsThePapersOne)
{
    const Trajectory truth = randomTrajectory(30, 1);
    const Trajectory estimate = perturbed(truth, 0.05, 2);
    RpeOptions options;
    options.fixedDelta = true;
    options.delta = 3;
    options.unit = DeltaUnit::Frames;
    options.formula = RpeFormula::Evo;
    for (const RpePair& pair : relativePoseError(truth, estimate, options).pairs)
    {
        EXPECT_EQ(pair.j, pair.i + 3);
        const Eigen::Isometry3d E =
            (truth.poses[pair.i].inverse() * truth.poses[pair.j]).inverse() *
            (estimate.poses[pair.i].inverse() * estimate.poses[pair.j]);
        EXPECT_NEAR(pair.translation, E.translation().norm(), 1e-12);
        EXPECT_NEAR(pair.rotation, rotationAngle(E.linear()), 1e-9);
    }
}

TEST(Rpe, deltaUnits)
{
    const Trajectory truth = line({0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5});
    const auto jOfFirst = [&](DeltaUnit unit, double delta, const Trajectory& t)
    {
        RpeOptions options;
        options.fixedDelta = true;
        options.unit = unit;
        options.delta = delta;
        return relativePoseError(t, t, options).pairs.at(0).j;
    };
    EXPECT_EQ(jOfFirst(DeltaUnit::Seconds, 2, truth), 2u);
    EXPECT_EQ(jOfFirst(DeltaUnit::Frames, 3, truth), 3u);
    EXPECT_EQ(jOfFirst(DeltaUnit::Metres, 2, truth), 4u);
    Trajectory turning = truth;
    for (std::size_t i = 0; i < turning.size(); ++i)
    {
        turning.poses[i].linear() = so3Exp({0, 0, 0.1 * static_cast<double>(i)});
    }
    EXPECT_EQ(jOfFirst(DeltaUnit::Radians, 0.41, turning), 4u);
    EXPECT_EQ(jOfFirst(DeltaUnit::Degrees, 5.7, turning), 1u);
    EXPECT_THROW((void)deltaUnitFromName("km"), std::invalid_argument);
    EXPECT_EQ(deltaUnitFromName("deg"), DeltaUnit::Degrees);
}

TEST(Rpe, overAGapAPoseIsPairedWithItself)
{
    Trajectory estimate = line({0, 1, 2, 3, 4});
    estimate.stamps = {0, 1, 2, 12, 13};
    Trajectory truth = randomTrajectory(200, 3);
    for (double& stamp : truth.stamps)
    {
        stamp -= 100;
    }
    RpeOptions options;
    options.fixedDelta = true;
    const RpeResult r = relativePoseError(truth, estimate, options);
    EXPECT_EQ(r.pairs.at(2).i, 2u);
    EXPECT_EQ(r.pairs.at(2).j, 2u);
    EXPECT_EQ(r.pairs.at(2).translation, 0);
    EXPECT_LT(r.coverage.share, 0.2);  // the title says so
}

TEST(Rpe, randomPairsAreRepeatableAndSaid)
{
    const Trajectory truth = randomTrajectory(150, 1);
    const Trajectory estimate = perturbed(truth, 0.02, 2);
    RpeOptions options;
    options.maxPairs = 10000;
    const RpeResult a = relativePoseError(truth, estimate, options);
    const RpeResult b = relativePoseError(truth, estimate, options);
    EXPECT_EQ(a.translation.count, 10000u);
    EXPECT_TRUE(a.randomPairs);
    EXPECT_EQ(a.translation.rmse, b.translation.rmse);
    options.seed = 2;
    EXPECT_NE(relativePoseError(truth, estimate, options).translation.rmse, a.translation.rmse);
    EXPECT_THAT(describe(options, a), HasSubstr("drawn with seed 2"));
    options.fixedDelta = true;
    options.maxPairs = 50;
    EXPECT_EQ(relativePoseError(truth, estimate, options).pairs.size(), 50u);
}

TEST(Rpe, titleStatesTheProtocol)
{
    const Trajectory truth = randomTrajectory(50, 1);
    RpeOptions options;
    options.fixedDelta = true;
    const std::string title = describe(options, relativePoseError(truth, truth, options));
    for (const char* part : {"evaluate_rpe", "fixed delta 1 s", "nearest stamp", "39 of 39 pairs"})
    {
        EXPECT_THAT(title, HasSubstr(part));
    }
}

TEST(Rpe, refusesWhatCannotBeScored)
{
    const Trajectory truth = line({0, 1, 2, 3});
    RpeOptions options;
    options.fixedDelta = true;
    EXPECT_THAT(
        refusalOf(truth, line({0, 1, 2}, 1000), options),
        AllOf(HasSubstr("[0.000, 3.000]"), HasSubstr("[1000.000, 1002.000]")));
    EXPECT_THROW((void)relativePoseError(truth, line({0}), options), std::runtime_error);
}

/** Not "0 of 0 pairs have ground truth": there is ground truth for all of it. */
TEST(Rpe, aRecordingThatIsShorterThanDeltaIsTold)
{
    const Trajectory brief = randomTrajectory(9, 1);
    RpeOptions options;
    options.fixedDelta = true;
    EXPECT_EQ(
        refusalOf(brief, brief, options),
        "'random' covers 0.8 s: fewer than two pairs of poses are 1 s apart (those with the last "
        "pose do not count); choose a smaller delta");
    options.unit = DeltaUnit::Frames;
    options.delta = 20;
    EXPECT_THAT(refusalOf(brief, brief, options), HasSubstr("covers 8 f: fewer than two pairs"));
    // It is long enough, but the ground truth begins with its last frame.
    options.delta = 2;
    EXPECT_THAT(
        refusalOf(withHole(randomTrajectory(40, 1), 0, 13), randomTrajectory(14, 1), options),
        AllOf(
            HasSubstr("only 0 of 11 pairs have ground truth within 0.2"),
            HasSubstr("of the same sequence?")));
}

/** As in the script: the nearest pose counts, however far it is. But it is told. */
TEST(Rpe, pairsThatAreFarOffTheirDeltaAreCounted)
{
    RpeOptions options;
    options.fixedDelta = true;
    options.unit = DeltaUnit::Metres;
    const Trajectory even = line({0, 1, 2, 3, 4, 5, 6});
    EXPECT_EQ(relativePoseError(even, even, options).pairsOffDelta, 0U);
    EXPECT_THAT(
        describe(options, relativePoseError(even, even, options)),
        testing::Not(HasSubstr("off by")));

    const Trajectory leap = line({0, 1, 2, 3.6, 4.6, 5.6, 6.6});  // 2 to 3.6: 1.6 instead of 1
    const RpeResult result = relativePoseError(leap, leap, options);
    EXPECT_EQ(result.pairsOffDelta, 1U);
    EXPECT_THAT(
        describe(options, result), HasSubstr("5 of 5 pairs, 1 off by more than half of delta"));

    const Trajectory stuck = line({0, 1, 2, 5, 6, 7, 8});  // 2 is nearer to 3 than 5 is
    const RpeResult both = relativePoseError(stuck, stuck, options);
    EXPECT_EQ(both.pairsOffDelta, 1U);
    EXPECT_THAT(
        describe(options, both), HasSubstr("1 of a pose with itself, as nothing is at its delta"));
}

/** As in the script: its last pose stands for those up to two intervals later. But it is told. */
TEST(Rpe, pairsWithGroundTruthOfAnotherTimeAreCounted)
{
    const Trajectory truth = line({0, 1, 2, 3, 4, 5});
    const Trajectory longer = line({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    for (const bool fixed : {true, false})
    {
        RpeOptions options;
        options.fixedDelta = fixed;
        const RpeResult result = relativePoseError(truth, longer, options);
        EXPECT_EQ(result.translation.max, fixed ? 1 : 2);  // of an estimate without errors
        EXPECT_EQ(result.pairsOfOtherTime, fixed ? 2U : 8 * 8U - 6 * 6U);
        EXPECT_THAT(
            describe(options, result),
            HasSubstr(
                fixed ? "7 of 8 pairs, 2 with ground truth an interval or more away"
                      : "64 of 100 pairs, 28 with ground truth an interval or more away"));
        options.truthAt = TruthAt::Interpolated;
        EXPECT_EQ(relativePoseError(truth, longer, options).pairsOfOtherTime, 0U);
        EXPECT_EQ(relativePoseError(truth, line({0, 1, 2, 3, 4}, 0.5), {}).pairsOfOtherTime, 0U);
    }
}

/** As in the script, over gaps; but it does not count for a measurement without a word. */
TEST(Rpe, aPoseIsNotComparedWithItselfWithoutAWord)
{
    const Trajectory truth = line({0, 1, 2, 3, 4, 5});
    const Trajectory estimate = line({0, 1, 3, 3, 4, 6});
    RpeOptions options;
    options.fixedDelta = true;
    options.delta = 0.4;
    EXPECT_THAT(
        [&] { (void)relativePoseError(truth, estimate, options); },
        testing::ThrowsMessage<std::runtime_error>(
            HasSubstr("delta 0.4 s is shorter than half the distance between poses")));

    options.delta = 1;
    EXPECT_THAT(
        describe(options, relativePoseError(truth, estimate, options)),
        testing::Not(HasSubstr("itself")));

    std::vector<StampedPose> poses;
    for (const double stamp : {0.0, 1.0, 2.0, 6.0, 7.0, 8.0})
    {
        poses.push_back({stamp, Eigen::Isometry3d::Identity(), {}});
        poses.back().pose.translation().x() = stamp;
    }
    const Trajectory gap = makeTrajectory("gap", poses);
    EXPECT_THAT(
        describe(options, relativePoseError(gap, gap, options)),
        HasSubstr("4 of 4 pairs, 1 of a pose with itself"));
}

TEST(Rpe, onePairIsTooFewWhateverTheGroundTruth)
{
    const Trajectory t = line({0, 1, 2, 3, 4, 5});
    RpeOptions options;
    options.maxPairs = 1;
    for (const bool fixed : {false, true})
    {
        options.fixedDelta = fixed;
        EXPECT_THAT(
            [&] { (void)relativePoseError(t, t, options); },
            testing::ThrowsMessage<std::runtime_error>(
                "only one pair was drawn (--max-pairs 1); at least two are needed"));
    }
}

/** Trajectories of programs, which makeTrajectory() never saw. */
TEST(Rpe, refusesATrajectoryThatIsNone)
{
    const Trajectory t = line({0, 1, 2, 3, 4, 5});
    const auto expectRefused = [&](const Trajectory& estimate, const char* message)
    {
        EXPECT_THAT(
            [&] { (void)relativePoseError(t, estimate, {}); },
            testing::ThrowsMessage<std::invalid_argument>(HasSubstr(message)));
    };
    Trajectory mixed = t;
    std::swap(mixed.stamps[1], mixed.stamps[4]);
    expectRefused(mixed, "stamps are not in order; makeTrajectory() sorts them");
    Trajectory cut = t;
    cut.poses.resize(3);
    expectRefused(cut, "has 6 stamps, but 3 poses");
    cut = t;
    cut.covs.resize(2, Matrix6d::Identity());
    expectRefused(cut, "has 6 stamps, but 2 covariances");
    cut = t;
    cut.status.resize(7);
    expectRefused(cut, "has 6 stamps, but 7 states");

    RpeOptions options;
    options.fixedDelta = true;
    options.delta = std::nan("");
    EXPECT_THROW((void)relativePoseError(t, t, options), std::invalid_argument);
    options.delta = 1;
    options.offset = std::nan("");
    EXPECT_THAT(
        [&] { (void)relativePoseError(t, t, options); },
        testing::ThrowsMessage<std::runtime_error>(HasSubstr("do not overlap")));
}
