// SPDX-License-Identifier: BSD-3-Clause
#include "Judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** All on surfaces that have not moved. */
void setInliers(Alignment& a, int number)
{
    a.estimate.numPointInliers = number;
    a.estimate.pointInlierWorth = number;
}

/** A good one: 300 points in view, all of which agree with the motion, as do all surfaces. */
Alignment makeAlignment(double sigmaOfPrediction)
{
    Alignment out;
    out.predicted.dt = 0.5;
    out.predicted.pose.cov = sigmaOfPrediction * sigmaOfPrediction * Matrix6d::Identity();
    out.estimate.infoPoints = 1e6 * Matrix6d::Identity();
    out.problem.points.resize(300);
    out.numSought = 300;
    setInliers(out, 300);
    out.estimate.pointChi2PerDof = 1;
    out.agreement.agrees = 1000;
    return out;
}

constexpr double kCertain = 0.01, kUncertain = 1;  // [m, rad]
const NoiseFactors kUsual{1, 1};

TEST(Judge, believesWhatPointsAndSurfacesConfirm)
{
    const Judge judge{OdometryParams{}};
    for (const double sigma : {kCertain, kUncertain})
    {
        Alignment a = makeAlignment(sigma);
        judge.judge(a);
        judge.contradict(a, kUsual);
        EXPECT_TRUE(a.holds) << a.reason;
        EXPECT_TRUE(Judge::isConvincing(a, kUsual));
        EXPECT_FALSE(Judge::mayBeChance(a));
        EXPECT_EQ(a.reason, "");
    }
}

/** Surfaces agree with any motion along a wall. */
TEST(Judge, surfacesAloneDoNotConvinceWhereThePredictionSaysNothing)
{
    for (const double sigma : {kCertain, kUncertain})
    {
        Alignment a = makeAlignment(sigma);
        setInliers(a, 100);
        Judge(OdometryParams{}).judge(a);
        EXPECT_EQ(Judge::isConvincing(a, kUsual), sigma == kCertain);
    }
}

TEST(Judge, fewPointsMayAgreeByChance)
{
    const auto mayBeChance = [](double sigma, int inliers, int sought)
    {
        Alignment a = makeAlignment(sigma);
        setInliers(a, inliers);
        a.numSought = sought;
        Judge(OdometryParams{}).judge(a);
        return Judge::mayBeChance(a);
    };
    EXPECT_TRUE(mayBeChance(kUncertain, 100, 300));
    EXPECT_FALSE(mayBeChance(kUncertain, 200, 300)) << "most points in view agree";
    EXPECT_FALSE(mayBeChance(kCertain, 100, 300)) << "they were searched for where they are";
    EXPECT_TRUE(mayBeChance(kCertain, 1, 300));
    EXPECT_FALSE(mayBeChance(kCertain, 3, 3)) << "no other point is in view";
    EXPECT_FALSE(mayBeChance(kCertain, 7, 12)) << "most points in view agree";
    EXPECT_FALSE(mayBeChance(kCertain, 6, 18)) << "a third of the points in view agrees";
    EXPECT_TRUE(mayBeChance(kCertain, 5, 18));
}

/** Planes that slide along themselves hide it from the surfaces. */
TEST(Judge, otherMotionsAreTriedWherePointsShouldAgree)
{
    Alignment a = makeAlignment(kCertain);
    Judge(OdometryParams{}).judge(a);
    EXPECT_TRUE(Judge::needsNoOther(a, kUsual));
    a.problem.planes.resize(7);
    setInliers(a, 1);
    EXPECT_TRUE(Judge::isConvincing(a, kUsual));
    EXPECT_FALSE(Judge::needsNoOther(a, kUsual));
    a.numSought = 1;
    EXPECT_TRUE(Judge::needsNoOther(a, kUsual)) << "no other point is in view";
}

/** Without depth, no surface can contradict: most points have to agree. */
TEST(Judge, whereNoSurfaceIsSeenMostPointsHaveToAgree)
{
    for (const double sigma : {kCertain, kUncertain})
    {
        Alignment a = makeAlignment(sigma);
        a.agreement = {};
        Judge(OdometryParams{}).judge(a);
        EXPECT_TRUE(Judge::isConvincing(a, kUsual));
        EXPECT_FALSE(Judge::mayBeChance(a));
        setInliers(a, 100);
        EXPECT_FALSE(Judge::isConvincing(a, kUsual));
        EXPECT_TRUE(Judge::mayBeChance(a));
    }
}

/** Some hundreds of samples are compared where depth is seen; a few may lie on an edge. */
TEST(Judge, fewSamplesOfSurfacesDoNotContradict)
{
    for (const int samples : {3, 300})
    {
        Alignment a = makeAlignment(kCertain);
        a.agreement = {};
        a.agreement.vanished = samples;
        const Judge judge{OdometryParams{}};
        judge.judge(a);
        judge.contradict(a, kUsual);
        EXPECT_EQ(a.holds, samples == 3) << a.reason;
    }
}

TEST(Judge, planesAreDoubtedWherePointsShouldAgree)
{
    const auto judged = [](double sigma, int inView, int surfaces)
    {
        Alignment a = makeAlignment(sigma);
        a.problem.points.clear();
        a.problem.planes.resize(5);
        setInliers(a, 0);
        a.numSought = inView;
        a.agreement = {surfaces, 0, 1000 - surfaces};
        const Judge judge{OdometryParams{}};
        judge.judge(a);
        judge.contradict(a, kUsual);
        return a;
    };
    for (const double sigma : {kCertain, kUncertain})
    {
        const Alignment doubted = judged(sigma, 300, 700);
        EXPECT_FALSE(doubted.holds) << "neither points nor surfaces agree";
        EXPECT_THAT(
            doubted.reason,
            testing::StartsWith("only 0 of 300 points in view agree with the motion, 0.500 s "));
        EXPECT_TRUE(judged(sigma, 300, 800).holds);
        EXPECT_TRUE(judged(sigma, 0, 700).holds) << "no points to ask";
    }
}

TEST(Judge, surfacesThatAreNotWhereTheyShouldBeContradict)
{
    Alignment a = makeAlignment(kCertain);
    a.agreement = {400, 0, 600};
    const Judge judge{OdometryParams{}};
    judge.judge(a);
    EXPECT_TRUE(a.holds);
    judge.contradict(a, kUsual);
    EXPECT_FALSE(a.holds);
    EXPECT_THAT(a.reason, testing::HasSubstr("only 40 %"));
}

/** Of a motion that nothing foresaw, surfaces and points may say little; planes say more. */
TEST(Judge, planesThatAreElsewhereContradict)
{
    for (const double sigma : {kCertain, kUncertain})
    {
        for (const double rise : {20.0, 300.0})
        {
            Alignment a = makeAlignment(sigma);
            a.agreement = {600, 0, 400};
            setInliers(a, 100);
            a.estimate.planeChi2PerDof = rise;
            const Judge judge{OdometryParams{}};
            judge.judge(a);
            judge.contradict(a, kUsual);
            EXPECT_EQ(a.holds, rise == 20) << a.reason;
        }
    }
}

TEST(Judge, farFromThePredictionOnlyWhatConvincesIsBelieved)
{
    for (const double rise : {1.0, 10.0})
    {
        Alignment a = makeAlignment(kCertain);
        a.estimate.motion.mean.T_prev_cur.translation().x() = 1;
        a.estimate.pointChi2PerDof = rise;
        const Judge judge{OdometryParams{}};
        judge.judge(a);
        judge.contradict(a, kUsual);
        EXPECT_EQ(a.holds, rise == 1.0) << a.reason;
    }
}

/** Directions that are predicted cannot be far from the prediction. */
TEST(Judge, onlyMeasuredDirectionsTellHowFarThatIs)
{
    for (const int measured : {1, 2, 6})
    {
        Alignment a = makeAlignment(kCertain);
        a.estimate.infoPoints.setZero();
        a.estimate.infoPoints.diagonal().head(measured).setConstant(1e6);
        a.estimate.motion.mean.T_prev_cur.translation().x() = 6 * kCertain;
        const Judge judge{OdometryParams{}};
        judge.judge(a);
        ASSERT_EQ(a.observableDirections, measured);
        EXPECT_EQ(Judge::isSurprising(a), measured == 1) << "6, 4.2 and 2.4 standard deviations";
    }
}

/** Whether the first of two alignments is kept, whatever their order. */
bool isBetter(const Alignment& one, const Alignment& other)
{
    const auto kept = [](Alignment best, const Alignment& next)
    {
        Judge::keepBetter(best, next, kUsual);
        return best.estimate.motion.mean.velocity.x();
    };
    Alignment marked = one;
    marked.estimate.motion.mean.velocity.x() = 1;
    return kept(marked, other) == 1 && kept(other, marked) == 1;
}

TEST(Judge, alignmentsThatAgreeWithinTheirStandardDeviationsAreTheSame)
{
    const auto at = [](double x, double information)
    {
        Alignment out = makeAlignment(kCertain);
        out.holds = true;
        out.estimate.motion.mean.T_prev_cur.translation().x() = x;
        out.estimate.motion.cov.topLeftCorner<6, 6>() = Matrix6d::Identity() / information;
        return out;
    };
    // 1 mm and 1 mrad: 2 mm in one of six directions are 2 / sqrt(6) standard deviations.
    EXPECT_TRUE(Judge::areSame(at(0, 1e6), at(0.002, 1e6)));
    EXPECT_FALSE(Judge::areSame(at(0, 1e6), at(0.003, 1e6)));
    EXPECT_FALSE(Judge::areSame(at(0, 1e2), at(0.003, 1e6))) << "the certain one decides";
    EXPECT_FALSE(Judge::areSame(at(0.003, 1e6), at(0, 1e2)));
    Alignment fails = at(0, 1e6);
    fails.holds = false;
    EXPECT_FALSE(Judge::areSame(at(0, 1e6), fails));
}

TEST(Judge, moreSurfacesAndMorePointsAreBetter)
{
    const Alignment good = makeAlignment(kCertain);
    Alignment fewer = good;
    setInliers(fewer, 100);
    EXPECT_TRUE(isBetter(good, fewer));
    Alignment less = good;
    less.agreement = {700, 100, 200};
    EXPECT_TRUE(isBetter(good, less));
    Alignment held = less;
    held.holds = true;
    EXPECT_TRUE(isBetter(held, good));
}

/** Most of the few points that are left in view agree by chance. */
TEST(Judge, aMotionThatLooksAwayFromMostPointsIsNotConfirmedByTheRest)
{
    Alignment away = makeAlignment(kUncertain);
    away.numSought = 20;
    setInliers(away, 15);
    Alignment near = makeAlignment(kUncertain);
    setInliers(near, 10);
    EXPECT_TRUE(isBetter(away, near));

    Judge(OdometryParams{}).judge(away);
    EXPECT_TRUE(Judge::isConvincing(away, kUsual));
    Judge::keepBetter(away, near, kUsual);
    EXPECT_FALSE(Judge::isConvincing(away, kUsual));
}

/** A motion between that of the still world and that of what moves agrees with neither. */
TEST(Judge, moreSurfacesDoNotOutweighResidualsOfNoMotion)
{
    Alignment right = makeAlignment(kCertain);
    right.agreement = {600, 0, 400};
    Alignment between = makeAlignment(kCertain);
    between.estimate.pointChi2PerDof = 10;
    EXPECT_TRUE(isBetter(right, between));
}

/** Planes alone have no residuals of points. */
TEST(Judge, residualsOfNoPointsDoNotOutweighThoseOfABlurredFrame)
{
    Alignment blurred = makeAlignment(kCertain);
    blurred.estimate.pointChi2PerDof = 2.1 * kUsual.points;
    blurred.numSought = 200;
    setInliers(blurred, 150);
    Alignment planes = makeAlignment(kCertain);
    planes.estimate.pointChi2PerDof = 0;
    setInliers(planes, 0);
    EXPECT_TRUE(isBetter(blurred, planes));
}

TEST(Judge, residualsDoNotDecideBetweenTwoMotionsOfABlurredFrame)
{
    Alignment more = makeAlignment(kCertain);
    more.estimate.pointChi2PerDof = 21;
    Alignment fewer = makeAlignment(kCertain);
    fewer.estimate.pointChi2PerDof = 18;
    setInliers(fewer, 200);
    EXPECT_TRUE(isBetter(more, fewer));
}

Rivalry rivalryOf(double areaFirst, double areaSecond)
{
    Rivalry out;
    out.areaFirst = areaFirst;
    out.areaSecond = areaSecond;
    return out;
}

TEST(Judge, aMotionThatExplainsHalfAsMuchSurfaceAgainIsTheCameras)
{
    EXPECT_EQ(Judge::whyUnsettled(rivalryOf(1.6, 1)), "");
    EXPECT_THAT(Judge::whyUnsettled(rivalryOf(1.4, 1)), testing::HasSubstr("as much surface"));
    EXPECT_EQ(Judge::whyUnsettled(rivalryOf(1, 1.6)), "") << "even if the estimate went with less";
    EXPECT_THAT(Judge::whyUnsettled(rivalryOf(1, 1.4)), testing::HasSubstr("as much surface"));
}

/** More of them agree with the other motion, but they are on what has moved before. */
TEST(Judge, pointsOnWhatMovesDoNotSpeakForAMotion)
{
    Alignment still = makeAlignment(kCertain), moving = still;
    still.estimate.numPointInliers = 120;
    still.estimate.pointInlierWorth = 100;
    moving.estimate.numPointInliers = 220;
    moving.estimate.pointInlierWorth = 50;
    Judge::keepBetter(moving, still, {1, 1});
    EXPECT_EQ(moving.estimate.numPointInliers, 120);
}

TEST(Judge, anUnsettledMotionIsNotBelieved)
{
    Alignment a = makeAlignment(kCertain);
    const Judge judge{OdometryParams{}};
    judge.judge(a);
    a.unsettled = "two motions";
    judge.contradict(a, kUsual);
    EXPECT_FALSE(a.holds);
    EXPECT_EQ(a.reason, "two motions");
}

TEST(Judge, aNewViewIsNeededWhereMuchHasMoved)
{
    Alignment a = makeAlignment(kCertain);
    MovingRegions much;
    much.cells.resize(2);
    much.numCompared = 10;
    EXPECT_FALSE(Judge::needsNewView(a, much)) << "the key frame still shows what is there";
    a.agreement = {600, 200, 200};
    EXPECT_TRUE(Judge::needsNewView(a, much));
    EXPECT_FALSE(Judge::needsNewView(a, MovingRegions())) << "nothing moves";
}
}  // namespace
}  // namespace pointplane
