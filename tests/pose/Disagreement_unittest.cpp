// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/PoseSolver.h>

#include <vector>

#include "synthetic_pairs.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kNumRuns = 300;

/** Every other feature comes from another reference. */
template <class Pairs>
void splitInTwo(Pairs& pairs)
{
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        pairs[i].reference = static_cast<int>(i % 2);
    }
}

struct Ratios
{
    double points{0}, planes{0};
};

PoseAnalysis analyse(const PoseProblem& problem)
{
    const PoseSolver solver(test::gaussianSolver());
    return solver.analyse(problem, solver.solve(problem, {}));
}

/** Mean disagreement of two references over the expected one.
 * \param noise scale of sigma over the claimed one
 * \param sigmaCommon [m, rad] of an error of pose that all points of a reference have in common */
Ratios disagreement(unsigned seed, double noise, double sigmaCommon)
{
    test::PairWorld w = test::moved(seed, 40, 6);
    Disagreement points, planes;
    for (int run = 0; run < kNumRuns; ++run)
    {
        std::vector<PointPair> pointPairs = w.drawPoints(noise);
        std::vector<PlanePair> planePairs = w.drawPlanes(noise);
        splitInTwo(pointPairs);
        splitInTwo(planePairs);
        const Eigen::Isometry3d errors[2] = {
            se3Exp(sigmaCommon * w.sampler().vector<6>()),
            se3Exp(sigmaCommon * w.sampler().vector<6>())};
        for (PointPair& pair : pointPairs)
        {
            pair.ref.mean = errors[pair.reference] * pair.ref.mean;
        }
        const PoseAnalysis e = analyse(test::atRest(pointPairs, planePairs));
        points.observed += e.pointDisagreement.observed;
        points.expected += e.pointDisagreement.expected;
        planes.observed += e.planeDisagreement.observed;
        planes.expected += e.planeDisagreement.expected;
    }
    return {points.observed / points.expected, planes.observed / planes.expected};
}
}  // namespace

/** Mean of kNumRuns squares with more than ten degrees of freedom each: 3 sigma are below 8 %. */
TEST(Disagreement, isAsExpectedOfIndependentErrors)
{
    const Ratios r = disagreement(71, 1, 0);
    EXPECT_NEAR(r.points, 1, 0.1);
    EXPECT_NEAR(r.planes, 1, 0.1);
}

TEST(Disagreement, growsWithTheSquareOfTheNoise)
{
    const Ratios r = disagreement(72, 3, 0);
    EXPECT_NEAR(r.points, 9, 0.9);
    EXPECT_NEAR(r.planes, 9, 0.9);
}

/** Residuals hardly show it: each reference's points agree with each other. */
TEST(Disagreement, showsErrorsThatPointsHaveInCommon)
{
    EXPECT_GT(disagreement(73, 1, 3e-3).points, 3);
}

TEST(Disagreement, oneReferenceOfOneKindHasNothingToCompareWith)
{
    test::PairWorld w = test::moved(74, 40, 6);
    const PoseAnalysis e = analyse(test::atRest(w.drawPoints(), {}));
    EXPECT_EQ(e.pointDisagreement.expected, 0);
    EXPECT_EQ(e.planeDisagreement.expected, 0);
}

TEST(Disagreement, pointsAndPlanesOfOneReferenceAreCompared)
{
    test::PairWorld w = test::moved(75, 40, 6);
    const PoseAnalysis e = analyse(test::atRest(w.drawPoints(), w.drawPlanes()));
    EXPECT_GT(e.pointDisagreement.expected, 0);
    EXPECT_GT(e.planeDisagreement.expected, 0);
}
/** With a quarter of the points, a turn is told with four times the variance;
 * what the solver was told of their noise does not matter, nor do planes. */
TEST(TurnVariance, isThatOfTheNoiseOfPoints)
{
    const auto variance = [](int numPoints, double noise, int numPlanes)
    {
        test::PairWorld w = test::moved(75, numPoints, 6);
        std::vector<PointPair> points = w.drawPoints(0);
        std::vector<PlanePair> planes = w.drawPlanes(0);
        planes.resize(static_cast<size_t>(numPlanes));
        splitInTwo(points);
        PoseProblem problem = test::atRest(points, planes);
        problem.noise.points = noise;
        return analyse(problem).turnVariance;
    };
    const double many = variance(800, 1, 6);
    EXPECT_NEAR(variance(200, 1, 6) / many, 4, 0.5);
    EXPECT_NEAR(variance(800, 9, 6) / many, 1, 1e-6);
    EXPECT_NEAR(variance(800, 1, 0) / many, 1, 1e-6);
    EXPECT_EQ(variance(0, 1, 6), 0);
}

/** Three axes over what is known of all. */
TEST(TurnVariance, isTheHarmonicMeanOverAxes)
{
    test::PairWorld w = test::moved(76, 60, 0);
    const PoseProblem problem = test::atRest(w.drawPoints(0), {});
    const PoseEstimate estimate = PoseSolver(test::gaussianSolver()).solve(problem, {});
    const double information = estimate.infoPoints.bottomRightCorner<3, 3>().trace();
    EXPECT_NEAR(analyse(problem).turnVariance, 3 / information, 1e-9 / information);
}
}  // namespace pointplane
