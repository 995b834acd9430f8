// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/PoseSolver.h>

#include <cmath>
#include <vector>

#include "synthetic_pairs.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::PairWorld;

int patchOf(const Eigen::Vector3d& p)
{
    const auto part = [](double along) { return std::min(3, static_cast<int>(4 * along)); };
    return 4 * part((p.y() / p.z() + 0.45) / 0.9) + part((p.x() / p.z() + 0.6) / 1.2);
}

/** Points of a frame and of a reference, each with depths that a scale per patch has changed: by
 * what their covariances say, but neighbours alike. */
std::vector<PointPair> bent(PairWorld& world, double sigma, test::GaussianSampler& sampler)
{
    const Eigen::Matrix<double, kNumPatches, 1> ofRef = sigma * sampler.vector<kNumPatches>(),
                                                ofCur = sigma * sampler.vector<kNumPatches>();
    std::vector<PointPair> out = world.drawPoints();
    for (PointPair& pair : out)
    {
        pair.refPatch = pair.curPatch = patchOf(pair.ref.mean);
        for (PointGaussian* point : {&pair.ref, &pair.cur})
        {
            point->cov += sigma * sigma * point->mean * point->mean.transpose();  // as propagated
        }
        pair.ref.mean *= 1 + ofRef[pair.refPatch];
        pair.cur.mean *= 1 + ofCur[pair.curPatch];
        pair.dRef_dCamera.col(kDepthScale) = pair.ref.mean;
        pair.dCur_dCamera.col(kDepthScale) = pair.cur.mean;
    }
    return out;
}

/** Mean of what 200 draws say, over the true variance. */
double ratio(double sigma, int numPoints)
{
    test::GaussianSampler sampler(31);
    PairWorld world(32);
    world.addPoints(numPoints);
    world.T_prev_cur.translation().x() = 0.02;
    const PoseSolver solver({});
    double sum = 0, dof = 0;
    for (int i = 0; i < 200; ++i)
    {
        const PoseProblem problem = test::atRest(bent(world, sigma, sampler), {});
        const auto patches = solver.analyse(problem, solver.solve(problem, {})).patchResiduals;
        sum += patches.at(0).dof * patches.at(0).variance;
        dof += patches.at(0).dof;
    }
    return sum / dof / (sigma * sigma);
}
}  // namespace

/** Where depths of neighbours err together by more than their noise, whatever the pose follows. */
TEST(PatchResiduals, tellHowMuchPatchesErr)
{
    EXPECT_NEAR(ratio(0.005, 400), 1, 0.15);
    EXPECT_NEAR(ratio(0.01, 400), 1, 0.15);
    EXPECT_NEAR(ratio(0.01, 120), 1, 0.2);
}

/** Noise of single points is not taken for an error that they share. */
TEST(PatchResiduals, tellNothingOfNoise)
{
    test::GaussianSampler sampler(33);
    PairWorld world(34);
    world.addPoints(300);
    const PoseSolver solver({});
    double sum = 0;
    for (int i = 0; i < 200; ++i)
    {
        const PoseProblem problem = test::atRest(bent(world, 0, sampler), {});
        sum += solver.analyse(problem, solver.solve(problem, {})).patchResiduals.at(0).variance;
    }
    EXPECT_NEAR(sum / 200, 0, 0.001 * 0.001);
}

TEST(PatchResiduals, needPatchesAndDepth)
{
    test::GaussianSampler sampler(35);
    PairWorld world(36);
    world.addPoints(50);
    std::vector<PointPair> points = bent(world, 0.01, sampler);
    const PoseSolver solver({});
    const auto numReferences = [&]
    {
        const PoseProblem problem = test::atRest(points, {});
        return solver.analyse(problem, solver.solve(problem, {})).patchResiduals.size();
    };
    EXPECT_EQ(numReferences(), 1U);
    for (PointPair& pair : points)
    {
        pair.hasDepth = false;
    }
    EXPECT_EQ(numReferences(), 0U);
    for (PointPair& pair : points)
    {
        pair.hasDepth = true;
        pair.refPatch = pair.curPatch = -1;
    }
    EXPECT_EQ(numReferences(), 0U);
}
}  // namespace pointplane
