// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/PlaneErrors.h>

#include <cmath>
#include <map>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
const std::map<int, double> kCorrelation{{0, 1.0}, {1, 0.5}, {2, 0.1}};

/** What three references show of planes with these errors. */
PlaneResiduals residuals(double own, double byView, double followed = 0)
{
    PlaneResiduals out;
    out.followed = followed;
    for (const auto& [reference, correlation] : kCorrelation)
    {
        out.references.push_back({reference, own + byView * (1 - correlation), 9});
    }
    return out;
}

PlaneErrors learnt(const PlaneResiduals& from, int frames = 300)
{
    PlaneErrors out(2);
    for (int k = 0; k < frames; ++k)
    {
        out.update(from, kCorrelation, 1.0 / 30);
    }
    return out;
}
}  // namespace

TEST(PlaneErrors, areOneBeforeAnythingIsKnown)
{
    const PlaneErrors errors(2);
    EXPECT_EQ(errors.own(), 1);
    EXPECT_EQ(errors.byView(), 1);
}

/** Within what the prior weighs. */
TEST(PlaneErrors, tellNoiseFromErrorsByTheView)
{
    for (const auto& [own, byView] :
         {std::pair(0.5, 0.0), std::pair(2.0, 8.0), std::pair(0.3, 30.0)})
    {
        const PlaneErrors errors = learnt(residuals(own, byView));
        EXPECT_NEAR(errors.own(), own, 0.03 * (own + byView));
        EXPECT_NEAR(errors.byView(), byView, 0.03 * (own + byView));
    }
}

/** The prior counts as the three dimensions of a plane. One reference with one plane, y = 4 at the
 * same view: own = (3 + 3 * 4) / (3 + 3). */
TEST(PlaneErrors, oneFrameByHand)
{
    PlaneErrors errors(2);
    PlaneResiduals one;
    one.followed = 0;
    one.references = {{0, 4, 3}};
    errors.update(one, {{0, 1.0}}, 1.0 / 30);
    EXPECT_NEAR(errors.own(), 2.5, 1e-12);
    EXPECT_NEAR(errors.byView(), 1, 1e-12);
}

TEST(PlaneErrors, forgetOverTheTimeConstant)
{
    PlaneErrors errors = learnt(residuals(4, 0));
    for (int k = 0; k < 60; ++k)
    {
        errors.update(residuals(1, 0), kCorrelation, 1.0 / 30);
    }
    EXPECT_NEAR(errors.own(), 1 + 3 * std::exp(-1), 0.05);
}

TEST(PlaneErrors, aWrongMatchCountsLittle)
{
    PlaneErrors errors = learnt(residuals(1, 0));
    errors.update(residuals(1e6, 0), kCorrelation, 1.0 / 30);
    EXPECT_LT(errors.own(), 1.3);
}

/** Residuals that a fit has followed are small whatever the errors are: then the pixels of the
 * planes have the word, and the ratio is kept. */
TEST(PlaneErrors, areNotSmallerThanWhatThePoseFollows)
{
    const PlaneErrors alone = learnt(residuals(0.2, 0.8, 1)),
                      withPoints = learnt(residuals(0.2, 0.8, 0.1));
    EXPECT_NEAR(alone.own(), 1, 1e-12);
    EXPECT_NEAR(alone.byView() / alone.own(), withPoints.byView() / withPoints.own(), 1e-9);
    EXPECT_NEAR(withPoints.own(), 0.2, 0.03);
}

TEST(PlaneErrors, areNeverNegative)
{
    PlaneResiduals falling;  // nearer views look less alike, by chance
    falling.followed = 0;
    falling.references = {{0, 9, 9}, {2, 1, 9}};
    PlaneErrors errors = learnt(falling);
    EXPECT_EQ(errors.byView(), 0);
    EXPECT_GT(errors.own(), 0);
    falling.references = {{0, 0, 9}, {2, 50, 9}};
    errors = learnt(falling);
    EXPECT_GT(errors.own(), 0);
    EXPECT_GT(errors.byView(), 10);
}

TEST(PlaneErrors, keepWhatIsKnownWhereNothingTells)
{
    PlaneErrors errors = learnt(residuals(4, 8));
    const double own = errors.own();
    errors.update({}, {}, 1.0 / 30);
    EXPECT_NEAR(errors.own(), own, 0.02 * own);
}
}  // namespace pointplane
