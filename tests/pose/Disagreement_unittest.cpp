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
void split(Pairs& pairs, size_t numReferences = 2)
{
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        pairs[i].reference = static_cast<int>(i % numReferences);
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

/** Mean disagreement of two references, or of points and planes of one, over the expected one.
 * \param noise scale of sigma over the claimed one
 * \param sigmaCommon [m, rad] of an error of pose that all points of a reference have in common */
Ratios disagreement(unsigned seed, double noise, double sigmaCommon, size_t numReferences = 2)
{
    test::PairWorld w = test::moved(seed, 40, 6);
    Disagreement points, planes;
    for (int run = 0; run < kNumRuns; ++run)
    {
        std::vector<PointPair> pointPairs = w.drawPoints(noise);
        std::vector<PlanePair> planePairs = w.drawPlanes(noise);
        split(pointPairs, numReferences);
        split(planePairs, numReferences);
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

/** Residuals hardly show it: each reference's points agree with each other. Of two references with
 * the information H / 2 each, whose poses err by sigma in every direction, the gradients have the
 * covariance sigma^2 H^2 / 8, besides that of noise, H / 4. */
TEST(Disagreement, showsErrorsThatPointsHaveInCommon)
{
    constexpr int kNumPoints = 100;
    constexpr double kSigma = 5e-4;
    test::PairWorld w = test::moved(73, kNumPoints, 0);
    const PoseSolver solver(test::gaussianSolver());
    Disagreement sum;
    double information = 0;
    for (int run = 0; run < kNumRuns; ++run)
    {
        std::vector<PointPair> pairs = w.drawPoints();
        split(pairs);
        const Eigen::Isometry3d errors[2] = {
            se3Exp(kSigma * w.sampler().vector<6>()), se3Exp(kSigma * w.sampler().vector<6>())};
        for (PointPair& pair : pairs)
        {
            pair.ref.mean = errors[pair.reference] * pair.ref.mean;
        }
        const PoseProblem problem = test::atRest(pairs, {});
        const PoseEstimate estimate = solver.solve(problem, {});
        const Disagreement of = solver.analyse(problem, estimate).pointDisagreement;
        sum.observed += of.observed;
        sum.expected += of.expected;
        information += estimate.infoPoints.trace() / kNumRuns;
    }
    const double expected = 1 + kSigma * kSigma * information / 12;
    EXPECT_GT(expected, 3);
    // The halves are not quite alike. Three standard deviations of the mean are 15 %.
    EXPECT_NEAR(sum.observed / sum.expected, expected, 0.2 * expected);
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
    const Ratios r = disagreement(75, 1, 0, 1);
    EXPECT_NEAR(r.points, 1, 0.1);
    EXPECT_NEAR(r.planes, 1, 0.1);
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
        split(points);
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
