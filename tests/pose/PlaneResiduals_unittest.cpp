// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/PoseSolver.h>

#include <vector>

#include "synthetic_pairs.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{

struct Told
{
    double variance, dof, followed;
};

/** Mean over noise that is `factor` times as large as propagated, of one reference. */
Told mean(unsigned seed, int numPoints, int numPlanes, double factor, int runs)
{
    test::PairWorld world(seed);
    world.addPoints(numPoints);
    world.addPlanes(numPlanes);
    const PoseSolver solver(test::gaussianSolver());
    Told out{0, 0, 0};
    int n = 0;
    for (int run = 0; run < runs; ++run)
    {
        PoseProblem problem = test::atRest(world.drawPoints(1), world.drawPlanes(factor));
        const PoseEstimate estimate = solver.solve(problem, {});
        const PlaneResiduals residuals = solver.analyse(problem, estimate).planeResiduals;
        out.followed += residuals.followed / runs;
        for (const ReferenceVariance& of : residuals.references)
        {
            out.variance += of.variance;
            out.dof = of.dof;
            ++n;
        }
    }
    out.variance /= std::max(1, n);
    return out;
}
}  // namespace

/** With many points, hardly anything of the pose follows two planes. */
TEST(PlaneResiduals, withManyPointsAreTheNoise)
{
    const Told told = mean(1, 2000, 2, 1, 1);
    EXPECT_LT(told.followed, 0.01);
    EXPECT_NEAR(told.dof, 6, 0.1);
}

/** Planes alone: six of their dimensions are lost, and made up for. A median of norms that have
 * lost unlike parts is made up for within a fifth. */
TEST(PlaneResiduals, ofPlanesAloneMakeUpForWhatThePoseFollows)
{
    const Told told = mean(2, 0, 8, 1, 300);
    EXPECT_NEAR(told.followed, 1, 1e-6);
    EXPECT_NEAR(told.dof, 3 * 8 - 6, 1e-6);
    EXPECT_NEAR(told.variance, 1, 0.2);
    EXPECT_NEAR(mean(2, 0, 8, 3, 300).variance, 9, 9 * 0.2) << "three times the noise";
}

TEST(PlaneResiduals, twoPlanesAloneTellNothing)
{
    test::PairWorld world(3);
    world.addPlanes(2);
    const PoseSolver solver(test::gaussianSolver());
    const PoseProblem problem = test::atRest({}, world.drawPlanes(1));
    const PlaneResiduals residuals =
        solver.analyse(problem, solver.solve(problem, {})).planeResiduals;
    EXPECT_TRUE(residuals.references.empty());
}

/** Also where they leave directions free. */
TEST(PlaneResiduals, nothingButPlanesIsFollowed)
{
    for (const int numPlanes : {1, 2, 3, 8})
    {
        test::PairWorld world(6);
        world.addPlanes(numPlanes);
        const PoseSolver solver(test::gaussianSolver());
        PoseProblem problem = test::atRest({}, world.drawPlanes(1));
        const PlaneResiduals residuals =
            solver.analyse(problem, solver.solve(problem, {})).planeResiduals;
        EXPECT_NEAR(residuals.followed, 1, 1e-6) << numPlanes;
    }
}

/** Of the second one, covariances are propagated 100 times as large as they are. */
TEST(PlaneResiduals, ofEachReference)
{
    constexpr int kDraws = 20;
    test::PairWorld world(4);
    world.addPoints(300);
    world.addPlanes(40);
    const PoseSolver solver(test::gaussianSolver());
    double first = 0, second = 0;
    for (int draw = 0; draw < kDraws; ++draw)
    {
        PoseProblem problem = test::atRest(world.drawPoints(), world.drawPlanes());
        for (size_t i = 0; i < problem.planes.size(); ++i)
        {
            PlanePair& pair = problem.planes[i];
            pair.reference = i % 2 == 0 ? 7 : 9;
            pair.cur.cov_m *= i % 2 == 0 ? 1 : 100;
            pair.ref.cov_m *= i % 2 == 0 ? 1 : 100;
        }
        const PlaneResiduals residuals =
            solver.analyse(problem, solver.solve(problem, {})).planeResiduals;
        ASSERT_EQ(residuals.references.size(), 2U);
        EXPECT_EQ(residuals.references[0].reference, 7);
        EXPECT_EQ(residuals.references[1].reference, 9);
        first += residuals.references[0].variance / kDraws;
        second += residuals.references[1].variance / kDraws;
    }
    // Medians of 20 planes each: three standard deviations of their mean are 20 %.
    EXPECT_NEAR(first, 1, 0.2);
    EXPECT_NEAR(second, 0.01, 0.2 * 0.01);
}

TEST(PlaneResiduals, withoutPlanesThereAreNone)
{
    test::PairWorld world(5);
    world.addPoints(30);
    const PoseSolver solver(test::gaussianSolver());
    const PoseProblem problem = test::atRest(world.drawPoints(1), {});
    const PlaneResiduals residuals =
        solver.analyse(problem, solver.solve(problem, {})).planeResiduals;
    EXPECT_TRUE(residuals.references.empty());
    EXPECT_NEAR(residuals.followed, 0, 1e-12);
}
}  // namespace pointplane
