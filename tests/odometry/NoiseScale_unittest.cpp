// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/NoiseScale.h>

#include <stdexcept>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
PoseAnalysis with(double pointVariance, double planeVariance)
{
    PoseAnalysis out;
    out.pointVariance = pointVariance;
    out.planeVariance = planeVariance;
    return out;
}

NoiseScale::TParams bare()
{
    NoiseScale::TParams params;
    params.pointFactor = params.planeFactor = 1;
    return params;
}

/** Learns from one more frame with this scatter. \return how bad it is */
double afterScatter(NoiseScale& noise, double scatter)
{
    PoseAnalysis frame = with(1, 1);
    frame.scatter = scatter;
    noise.update(frame, 1.0 / 30, true);
    return noise.ofFrame();
}
}  // namespace

TEST(NoiseScale, aFrameThatDoesNotTellItsNoiseIsAsOthers)
{
    NoiseScale noise(bare());
    (void)afterScatter(noise, 1);
    EXPECT_GT(afterScatter(noise, 5), 4);
    const double before = noise.factors().points;
    PoseAnalysis frame = with(50, 1);
    frame.scatter = 5;
    noise.update(frame, 1.0 / 30, false);
    EXPECT_EQ(noise.ofFrame(), 1);
    EXPECT_EQ(noise.factors().points, before);
}

TEST(NoiseScale, followsTheResiduals)
{
    NoiseScale noise(bare());
    for (int i = 0; i < 600; ++i)
    {
        noise.update(with(9, 0.5), 1.0 / 30, true);
    }
    EXPECT_NEAR(noise.factors().points, 9, 0.01);
    EXPECT_NEAR(noise.factors().planes, 0.5, 0.01);
}

TEST(NoiseScale, takesItsTime)
{
    NoiseScale noise(bare());
    const double before = noise.factors().points;
    noise.update(with(before + 10, 0), bare().timeConstant, true);
    EXPECT_NEAR(noise.factors().points, before + 10 * (1 - std::exp(-1)), 1e-12);
}

/** What the residuals say is told at once; the solver's factors keep to what they began with. */
TEST(NoiseScale, residualsAreAveragedFromTheStart)
{
    NoiseScale noise(bare());
    for (int i = 0; i < 12; ++i)
    {
        noise.update(with(0.5, 0.5), 1.0 / 30, true);
    }
    EXPECT_NEAR(noise.residuals().points, (3 * 4 + 12 * 0.5) / 15, 1e-12);
    EXPECT_NEAR(
        noise.typicalPoints().residuals, std::pow(4, 1.0 / 13) * std::pow(0.5, 12.0 / 13), 1e-12);
    EXPECT_GT(noise.factors().points, 2);
}

/** A frame with few points does not change what points usually tell, and one without says nothing.
 */
TEST(NoiseScale, howWellPointsTellATurnIsAGeometricMean)
{
    NoiseScale::TParams params = bare();
    params.adaptive = false;
    NoiseScale noise(params);
    EXPECT_EQ(noise.typicalPoints().turnVariance, 0);
    for (const double variance : {1e-6, 0.0, 1e-6, 1e-6, 1e-2})
    {
        PoseAnalysis frame;
        frame.turnVariance = variance;
        noise.update(frame, 1e-9, true);
    }
    EXPECT_NEAR(noise.typicalPoints().turnVariance, 1e-5, 1e-12);
}

TEST(NoiseScale, aFrameWithoutFeaturesTellsNothing)
{
    NoiseScale noise(bare());
    const NoiseFactors before = noise.factors();
    noise.update(with(0, 0), 1, true);
    EXPECT_EQ(noise.factors().points, before.points);
    EXPECT_EQ(noise.factors().planes, before.planes);
}

TEST(NoiseScale, staysWithinReason)
{
    NoiseScale noise(bare());
    for (int i = 0; i < 100; ++i)
    {
        noise.update(with(1e12, 1e-12), 1, true);
    }
    EXPECT_NEAR(noise.factors().points, 100, 1e-6);
    EXPECT_NEAR(noise.factors().planes, 0.1, 1e-6);
}

/** References disagree by what they were told too little of, until the factor is right. */
TEST(NoiseScale, followsTheDisagreementOfTheReferences)
{
    NoiseScale::TParams params;
    NoiseScale noise(params);
    const double truePoints = 5, truePlanes = 0.3;
    for (int i = 0; i < 1200; ++i)
    {
        const NoiseFactors told = noise.factors();
        PoseAnalysis frame = with(1, 1);
        frame.pointDisagreement = {truePoints / told.points, 1};
        frame.planeDisagreement = {2 * truePlanes / told.planes, 2};
        noise.update(frame, 1.0 / 30, true);
    }
    EXPECT_NEAR(noise.factors().points, truePoints * params.pointFactor, 0.01);
    EXPECT_NEAR(noise.factors().planes, truePlanes * params.planeFactor, 0.01);
}

TEST(NoiseScale, referencesThatCannotDisagreeTellNothing)
{
    NoiseScale noise(bare());
    PoseAnalysis frame;
    frame.pointDisagreement = {0, 0};
    const NoiseFactors before = noise.factors();
    noise.update(frame, 1, true);
    EXPECT_EQ(noise.factors().points, before.points);
}

/** Over the geometric mean of the frames before. */
TEST(NoiseScale, tellsABadFrame)
{
    NoiseScale noise(bare());
    const auto next = [&](double scatter) { return afterScatter(noise, scatter); };
    EXPECT_EQ(next(8), 1) << "nothing to compare the first one with";
    EXPECT_NEAR(next(2), 0.25, 1e-12);
    EXPECT_NEAR(next(40), 10, 1e-12);
    EXPECT_EQ(next(0), 1) << "nothing is known of it";
    for (int i = 0; i < 300; ++i)
    {
        EXPECT_LT(next(6), 1.1);
    }
    EXPECT_NEAR(next(300), 50, 0.5);
    EXPECT_NEAR(next(6), 1, 0.1) << "one bad frame hardly changes what is usual";
}

/** Images of a camera at rest may hold hardly any noise, until it moves; and the other way round.
 */
TEST(NoiseScale, noFrameIsCertainOrWorthless)
{
    NoiseScale noise(bare());
    const auto next = [&](double scatter) { return afterScatter(noise, scatter); };
    (void)next(1);
    EXPECT_EQ(next(1e-12), 0.1);
    for (int i = 0; i < 600; ++i)
    {
        (void)next(1e-12);
    }
    EXPECT_NEAR(next(1e-12), 1, 1e-3);
    EXPECT_EQ(next(1), 100);
}

TEST(NoiseScale, constantFactorsComeOnTop)
{
    NoiseScale::TParams params;
    params.adaptive = false;
    params.pointFactor = 3;
    params.planeFactor = 5;
    NoiseScale noise(params);
    noise.update(with(50, 50), 1, true);
    EXPECT_EQ(noise.factors().points, 3);
    EXPECT_EQ(noise.factors().planes, 5);
    EXPECT_EQ(noise.typicalPoints().residuals, 1);
}

TEST(NoiseScale, refusesParametersOutOfRange)
{
    const auto refused = [](auto change)
    {
        NoiseScale::TParams params;
        change(params);
        EXPECT_THROW(NoiseScale{params}, std::invalid_argument);
    };
    refused([](auto& p) { p.timeConstant = 0; });
    refused([](auto& p) { p.pointFactor = 0; });
    refused([](auto& p) { p.planeFactor = -1; });
}
}  // namespace pointplane
