// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/ErrorsByView.h"

#include <cmath>
#include <map>
#include <vector>

#include "monte_carlo.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
const std::map<int, double> kCorrelation{{0, 1.0}, {1, 0.5}, {2, 0.1}};

/** What three references show of these errors. */
std::vector<ReferenceVariance> residuals(double own, double byView)
{
    std::vector<ReferenceVariance> out;
    for (const auto& [reference, correlation] : kCorrelation)
    {
        out.push_back({reference, own + byView * (1 - correlation), 9});
    }
    return out;
}

ErrorsByView learnt(const std::vector<ReferenceVariance>& from, double followed = 0)
{
    ErrorsByView out(2);
    for (int k = 0; k < 300; ++k)
    {
        out.update(from, kCorrelation, 1.0 / 30, followed);
    }
    return out;
}
}  // namespace

TEST(ErrorsByView, areOneBeforeAnythingIsKnown)
{
    const ErrorsByView errors(2);
    EXPECT_EQ(errors.own(), 1);
    EXPECT_EQ(errors.byView(), 1);
}

/** Within what the prior weighs. */
TEST(ErrorsByView, tellNoiseFromErrorsByTheView)
{
    for (const auto& [own, byView] :
         {std::pair(0.5, 0.0), std::pair(2.0, 8.0), std::pair(0.3, 30.0)})
    {
        const ErrorsByView errors = learnt(residuals(own, byView));
        EXPECT_NEAR(errors.own(), own, 0.03 * (own + byView));
        EXPECT_NEAR(errors.byView(), byView, 0.03 * (own + byView));
    }
}

/** Ratios of variances scatter as chi-squares do: what is learnt is right on average, and as exact
 * as 60 frames of 27 degrees of freedom tell. */
TEST(ErrorsByView, areUnbiasedUnderNoise)
{
    constexpr int kDof = 9, kDraws = 300;
    constexpr double kByFrame = 2, kByView = 8;
    test::GaussianSampler random(1);
    double own = 0, byView = 0;
    for (int draw = 0; draw < kDraws; ++draw)
    {
        ErrorsByView errors(2);
        for (int frame = 0; frame < 300; ++frame)
        {
            std::vector<ReferenceVariance> noisy = residuals(kByFrame, kByView);
            for (ReferenceVariance& of : noisy)
            {
                of.variance *= random.vector<kDof>().squaredNorm() / kDof;
            }
            errors.update(noisy, kCorrelation, 1.0 / 30);
        }
        own += errors.own() / kDraws;
        byView += errors.byView() / kDraws;
    }
    EXPECT_NEAR(own, kByFrame, 0.05 * kByFrame);
    EXPECT_NEAR(byView, kByView, 0.05 * kByView);
}

/** The prior counts as the three dimensions of a plane. One reference with one plane, y = 4 at the
 * same view: own = (3 + 3 * 4) / (3 + 3). */
TEST(ErrorsByView, oneFrameByHand)
{
    ErrorsByView errors(2);
    errors.update({{0, 4, 3}}, {{0, 1.0}}, 1.0 / 30);
    EXPECT_NEAR(errors.own(), 2.5, 1e-12);
    EXPECT_NEAR(errors.byView(), 1, 1e-12);
}

TEST(ErrorsByView, forgetOverTheTimeConstant)
{
    ErrorsByView errors = learnt(residuals(4, 0));
    for (int k = 0; k < 60; ++k)
    {
        errors.update(residuals(1, 0), kCorrelation, 1.0 / 30);
    }
    EXPECT_NEAR(errors.own(), 1 + 3 * std::exp(-1), 0.05);
}

TEST(ErrorsByView, aWrongMatchCountsLittle)
{
    ErrorsByView errors = learnt(residuals(1, 0));
    errors.update(residuals(1e6, 0), kCorrelation, 1.0 / 30);
    EXPECT_LT(errors.own(), 1.3);
}

/** Residuals that a fit has followed are small whatever the errors are: then the pixels of the
 * planes have the word, and the ratio is kept. */
TEST(ErrorsByView, areNotSmallerThanWhatThePoseFollows)
{
    const ErrorsByView alone = learnt(residuals(0.2, 0.8), 1),
                       withPoints = learnt(residuals(0.2, 0.8), 0.1);
    EXPECT_NEAR(alone.own(), 1, 1e-12);
    EXPECT_NEAR(alone.byView() / alone.own(), withPoints.byView() / withPoints.own(), 1e-9);
    EXPECT_NEAR(withPoints.own(), 0.2, 0.03);
}

TEST(ErrorsByView, areNeverNegative)
{
    // Nearer views look less alike, by chance.
    ErrorsByView errors = learnt({{0, 9, 9}, {2, 1, 9}});
    EXPECT_EQ(errors.byView(), 0);
    EXPECT_GT(errors.own(), 0);
    errors = learnt({{0, 0, 9}, {2, 50, 9}});
    EXPECT_GT(errors.own(), 0);
    EXPECT_GT(errors.byView(), 10);
}

TEST(ErrorsByView, keepWhatIsKnownWhereNothingTells)
{
    ErrorsByView errors = learnt(residuals(4, 8));
    const double own = errors.own();
    errors.update({}, {}, 1.0 / 30);
    EXPECT_NEAR(errors.own(), own, 0.02 * own);
}
}  // namespace pointplane
