// SPDX-License-Identifier: BSD-3-Clause
#include "RivalMotions.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Points on a grid of 0.05 radians, so that each has a cell of the view of its own, that moved by
 * `shift` since the previous frame. \param z depth [m] \param column of the first one */
void addPoints(
    int columns, int rows, int column, double z, const Eigen::Vector3d& shift, PoseProblem& problem)
{
    for (int u = column; u < column + columns; ++u)
    {
        for (int v = 0; v < rows; ++v)
        {
            PointPair pair;
            pair.ref.mean = {z * (0.05 * u + 0.025), z * (0.05 * v + 0.025), z};
            pair.ref.cov = 1e-6 * z * z * Eigen::Matrix3d::Identity();
            pair.cur = pair.ref;
            pair.cur.mean += shift;
            problem.points.push_back(pair);
        }
    }
}

PoseProblem emptyProblem()
{
    PoseProblem out;
    out.prior = MotionPrior::fixedVelocity({});
    return out;
}

constexpr NoiseFactors kUsual{1, 1};

std::optional<Rivalry> rivalryIn(const PoseProblem& problem)
{
    const PoseSolver solver{PoseSolver::TParams()};
    return findRivalry(solver, problem, solver.solve(problem, {}), kUsual);
}

TEST(RivalMotions, nothingDisagreesAtRest)
{
    PoseProblem problem = emptyProblem();
    addPoints(10, 10, 0, 2, {0, 0, 0}, problem);
    EXPECT_FALSE(rivalryIn(problem));
}

/** 400 points in 100 cells that have moved by 3 cm at 1 m, 50 that have not at 2.5 m. */
TEST(RivalMotions, surfaceIsCountedByHand)
{
    PoseProblem problem = emptyProblem();
    for (int k = 0; k < 4; ++k)
    {
        addPoints(10, 10, 0, 1, {0.03, 0, 0}, problem);
    }
    addPoints(5, 10, 12, 2.5, {0, 0, 0}, problem);
    const auto rivalry = rivalryIn(problem);
    ASSERT_TRUE(rivalry);
    // The estimate follows the many and near ones; the camera goes where they seem to go from.
    EXPECT_NEAR(rivalry->first.T_prev_cur.translation().x(), -0.03, 1e-4);
    EXPECT_NEAR(rivalry->second.T_prev_cur.translation().norm(), 0, 1e-4);
    EXPECT_EQ(std::count(rivalry->points.begin(), rivalry->points.end(), Side::First), 400);
    EXPECT_EQ(std::count(rivalry->points.begin(), rivalry->points.end(), Side::Second), 50);
    const double cellAtOneMetre = 0.05 * 0.05;
    EXPECT_NEAR(rivalry->areaFirst, 100 * cellAtOneMetre, 10 * cellAtOneMetre);
    EXPECT_NEAR(rivalry->areaSecond, 50 * 6.25 * cellAtOneMetre, 1e-6);
    EXPECT_FALSE(rivalry->firstWins());
    EXPECT_EQ(&rivalry->winner(), &rivalry->second);
}

TEST(RivalMotions, halfAsMuchSurfaceAgainIsClear)
{
    Rivalry rivalry;
    rivalry.areaFirst = 1;
    rivalry.areaSecond = 1.4;
    EXPECT_FALSE(rivalry.isClear());
    rivalry.areaSecond = 1.6;
    EXPECT_TRUE(rivalry.isClear());
    EXPECT_FALSE(rivalry.firstWins());
}

/** An older reference in which what moves is not found any more. */
TEST(RivalMotions, theStillWorldAgreesOverReferences)
{
    PoseProblem problem = emptyProblem();
    addPoints(10, 10, 0, 1, {0.03, 0, 0}, problem);
    addPoints(4, 10, 12, 3, {0, 0, 0}, problem);
    const size_t ofOne = problem.points.size();
    addPoints(4, 10, 12, 3, {0, 0, 0}, problem);
    for (size_t i = ofOne; i < problem.points.size(); ++i)
    {
        problem.points[i].reference = 1;
    }
    const auto rivalry = rivalryIn(problem);
    ASSERT_TRUE(rivalry);
    EXPECT_NEAR(rivalry->winner().T_prev_cur.translation().norm(), 0, 1e-4);
    EXPECT_TRUE(rivalry->isClear());
}

TEST(RivalMotions, theLoserAndPointsOfNeitherAreLeftOut)
{
    Rivalry rivalry;
    rivalry.points = {Side::Both, Side::First, Side::Second, Side::Neither, Side::Second};
    rivalry.planes = {Side::Neither, Side::First};
    rivalry.areaSecond = 1;
    std::vector<Association> associations(2);
    for (int i = 0; i < 5; ++i)
    {
        PointTrack track;
        track.ref = i;
        associations[i < 3 ? 0 : 1].points.push_back(track);
    }
    associations[0].planes = {{0, 0}};
    associations[1].planes = {{1, 1}};
    leaveLoserOut(rivalry, associations);
    const auto refs = [](const std::vector<PointTrack>& tracks)
    {
        std::vector<int> out;
        for (const PointTrack& track : tracks)
        {
            out.push_back(track.ref);
        }
        return out;
    };
    EXPECT_EQ(refs(associations[0].points), (std::vector<int>{0, 2}));
    EXPECT_EQ(refs(associations[0].movingPoints), (std::vector<int>{1}));
    EXPECT_EQ(refs(associations[1].points), (std::vector<int>{4}));
    EXPECT_EQ(refs(associations[1].movingPoints), (std::vector<int>{3}));
    EXPECT_EQ(associations[0].planes.size(), 1U) << "planes lose weight by themselves";
    EXPECT_EQ(associations[1].movingPlanes.size(), 1U);
}

/** All of its points seem to have moved, and none agree with the others. */
TEST(RivalMotions, aReferenceWhosePoseIsOffIsNoMotion)
{
    PoseProblem problem = emptyProblem();
    addPoints(10, 10, 0, 2, {0, 0, 0}, problem);
    addPoints(6, 10, 0, 2, {0.03, 0, 0}, problem);
    for (size_t i = 100; i < problem.points.size(); ++i)
    {
        problem.points[i].reference = 1;
    }
    EXPECT_FALSE(rivalryIn(problem));
}

TEST(RivalMotions, wrongMatchesAreNoMotion)
{
    PoseProblem problem = emptyProblem();
    addPoints(10, 10, 0, 2, {0, 0, 0}, problem);
    for (int k = 0; k < 30; ++k)
    {
        addPoints(1, 1, 11 + k, 2, {0.1 * std::sin(k), 0.1 * std::cos(3 * k), 0}, problem);
    }
    EXPECT_FALSE(rivalryIn(problem));
}

TEST(RivalMotions, aHandfulOfPointsIsNoMotion)
{
    PoseProblem problem = emptyProblem();
    addPoints(10, 10, 0, 2, {0, 0, 0}, problem);
    addPoints(1, 10, 12, 1, {0.03, 0, 0}, problem);
    EXPECT_FALSE(rivalryIn(problem));
}
}  // namespace
}  // namespace pointplane
