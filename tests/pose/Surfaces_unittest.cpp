// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/PoseSolver.h>

#include <vector>

#include "matchers.h"
#include "synthetic_pairs.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kMoved = 3;  // which of the surfaces

PoseSolver::TParams withoutStudent()
{
    PoseSolver::TParams params = test::gaussianSolver();
    params.tukeySigmas = 4.7;
    return params;
}

/** Sixty points, ten on each of six planes. Plane kMoved has moved by 4 cm, and takes its points
 * along if it has any. */
PoseProblem oneMoved(test::PairWorld& w, bool hasPoints)
{
    const Eigen::Vector3d moved(0.04, 0, 0);
    PoseProblem out = test::atRest(w.drawPoints(0), w.drawPlanes(0));
    for (size_t i = 0; i < out.points.size(); ++i)
    {
        const int surface = static_cast<int>(i) % 6;
        out.points[i].surface = surface == kMoved && !hasPoints ? -1 : surface;
        out.points[i].cur.mean += surface == kMoved && hasPoints ? moved : Eigen::Vector3d::Zero();
    }
    for (size_t i = 0; i < out.planes.size(); ++i)
    {
        out.planes[i].feature = static_cast<int>(i);
    }
    Eigen::Isometry3d away = Eigen::Isometry3d::Identity();
    away.translation() = moved;
    out.planes[kMoved].cur = transformed(away, out.planes[kMoved].cur);
    return out;
}

double errorOf(const PoseProblem& problem, const Eigen::Isometry3d& truth)
{
    const PoseEstimate estimate = PoseSolver(withoutStudent()).solve(problem, {});
    return (estimate.motion.mean.T_prev_cur.translation() - truth.translation()).norm();
}
}  // namespace

TEST(InlierRatio, byHand)
{
    EXPECT_EQ(InlierRatio{}.value(), 1);
    EXPECT_EQ((InlierRatio{8, 3}.value()), 0.5);
    EXPECT_EQ((InlierRatio{8, 8}.value()), 1);
}

TEST(InlierRatio, fallsAtOnceHoweverLongAllWasWell)
{
    const InlierRatio moved = remembered({1000, 900}, {10, 0});
    EXPECT_EQ(moved.points, 10 + 10) << "a frame counts as much as all before";
    EXPECT_EQ(moved.inliers, 0 + 9);
    EXPECT_EQ(remembered(moved, {10, 0}).inliers, 4.5);
    EXPECT_EQ(remembered({4, 4}, {10, 0}).points, 14) << "of few before, all count";
}

TEST(InlierRatio, doesNotRiseByOneGoodFrame)
{
    const InlierRatio after = remembered({20, 5}, {10, 10});
    EXPECT_EQ(after.points, 20);
    EXPECT_EQ(after.inliers, 5);
    EXPECT_EQ(remembered({20, 5}, {}).points, 20) << "a frame without points tells nothing";
    EXPECT_EQ(remembered({}, {10, 10}).value(), 1);
}

TEST(Surfaces, aPlaneGoesWithThePointsOnIt)
{
    test::PairWorld w = test::moved(121, 60, 6);
    PoseProblem problem = oneMoved(w, true);
    const double without = errorOf(problem, w.T_prev_cur);
    problem.surfaces.resize(6);
    EXPECT_LT(errorOf(problem, w.T_prev_cur), 0.4 * without);
}

TEST(Surfaces, earlierFramesTellToo)
{
    test::PairWorld w = test::moved(122, 60, 6);
    PoseProblem problem = oneMoved(w, false);
    problem.surfaces.resize(6);
    const double without = errorOf(problem, w.T_prev_cur);
    problem.surfaces[kMoved] = {100, 0};
    EXPECT_LT(errorOf(problem, w.T_prev_cur), 0.2 * without);
}

/** Five of ten: half of the information. */
TEST(Surfaces, informationByHand)
{
    test::PairWorld w = test::moved(123, 10, 1);
    PoseProblem problem = test::atRest(w.drawPoints(0), w.drawPlanes(0));
    problem.planes[0].feature = 0;
    const PoseSolver solver(test::gaussianSolver());
    const PoseEstimate all = solver.solve(problem, {w.T_prev_cur, Vector6d::Zero()});
    problem.surfaces = {{8, 3}};
    PoseEstimate half = solver.solve(problem, {w.T_prev_cur, Vector6d::Zero()});
    EXPECT_THAT(half.infoPlanes, test::IsMatrixNear(0.5 * all.infoPlanes, 1e-3));
    EXPECT_THAT(half.infoPoints, test::IsMatrixNear(all.infoPoints, 1e-3)) << "they are elsewhere";
    for (PointPair& pair : problem.points)
    {
        pair.surface = 0;
    }
    problem.surfaces = {{18, 6}};  // the ten that agree now do not make it better
    half = solver.solve(problem, {w.T_prev_cur, Vector6d::Zero()});
    EXPECT_THAT(half.infoPlanes, test::IsMatrixNear(0.4 * all.infoPlanes, 1e-3));
    EXPECT_THAT(half.infoPoints, test::IsMatrixNear(0.4 * all.infoPoints, 1e-3));
    EXPECT_EQ(all.pointInlierWorth, all.numPointInliers);
    EXPECT_NEAR(half.pointInlierWorth, 0.4 * half.numPointInliers, 1e-9);
}

/** It has stood for a hundred frames; each of two frames in which it moves halves its weight. */
TEST(Surfaces, whatBeginsToMoveLosesItsWeight)
{
    test::PairWorld w = test::moved(126, 60, 6);
    PoseProblem problem = oneMoved(w, true);
    problem.surfaces.assign(6, {1000, 1000});
    const PoseSolver solver(withoutStudent());
    const PoseAnalysis first = solver.analyse(problem, solver.solve(problem, {}));
    EXPECT_LT(first.planeWeights[kMoved], 0.7);
    EXPECT_GT(first.planeWeights[0], 0.9);
    problem.surfaces = first.surfaces;
    const PoseAnalysis second = solver.analyse(problem, solver.solve(problem, {}));
    EXPECT_LT(second.planeWeights[kMoved], 0.45);
    EXPECT_GT(second.planeWeights[0], 0.9);
}

TEST(Surfaces, analysisTellsWhatIsKnownAfterTheFrame)
{
    test::PairWorld w = test::moved(124, 60, 6);
    PoseProblem problem = oneMoved(w, true);
    problem.surfaces.resize(6);
    problem.surfaces[0] = {4, 1};
    const PoseSolver solver(withoutStudent());
    const PoseAnalysis analysis = solver.analyse(problem, solver.solve(problem, {}));
    ASSERT_EQ(analysis.surfaces.size(), 6U);
    EXPECT_EQ(analysis.surfaces[0].points, 4) << "its points agree now: that does not help yet";
    EXPECT_EQ(analysis.surfaces[0].inliers, 1);
    EXPECT_EQ(analysis.surfaces[kMoved].points, 10);
    EXPECT_LT(analysis.surfaces[kMoved].inliers, 2);
    EXPECT_EQ(analysis.planeWeights[0], analysis.surfaces[0].value());
    EXPECT_LT(analysis.planeWeights[kMoved], 0.35);
}

/** As in the paper. */
TEST(Surfaces, withoutThemAllCountFully)
{
    test::PairWorld w = test::moved(125, 60, 6);
    const PoseProblem problem = oneMoved(w, true);
    const PoseSolver solver(withoutStudent());
    const PoseAnalysis analysis = solver.analyse(problem, solver.solve(problem, {}));
    EXPECT_TRUE(analysis.surfaces.empty());
    EXPECT_EQ(analysis.planeWeights[kMoved], 1);
}
}  // namespace pointplane
