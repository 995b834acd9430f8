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
/** Points of a person, nearer than the rest of the room. */
bool isNear(const PointPair& pair) { return pair.ref.mean.z() < 2.3; }

/** As a solver with a robust limit sees it. */
double pointVariance(const std::vector<PointPair>& points, const Motion& start)
{
    const PoseSolver solver(PoseSolver::TParams{});
    const PoseProblem problem = test::atRest(points, {}, start.T_prev_cur);
    return solver.analyse(problem, solver.solve(problem, start)).pointVariance;
}

double ofNoise(unsigned seed, double noise)
{
    test::PairWorld w = test::moved(seed, 600, 0);
    return pointVariance(w.drawPoints(noise), {w.T_prev_cur, Vector6d::Zero()});
}
}  // namespace

TEST(PointVariance, isThatOfTheNoise)
{
    // Over the propagated one, which has the noise of both features.
    EXPECT_NEAR(ofNoise(61, 1), 1, 0.15);
}

TEST(PointVariance, growsWithTheSquareOfTheNoise)
{
    EXPECT_NEAR(ofNoise(62, 3) / ofNoise(62, 1), 9, 0.3);
}

/** A third of all points walks by ten centimetres: the room does not become noisier for it. */
TEST(PointVariance, whatMovesHasNoPart)
{
    test::PairWorld w = test::moved(63, 600, 0);
    const Motion start{w.T_prev_cur, Vector6d::Zero()};
    std::vector<PointPair> points = w.drawPoints(1);
    std::vector<PointPair> room;
    for (PointPair& pair : points)
    {
        if (isNear(pair))
        {
            pair.cur.mean.x() += 0.1;
        }
        else
        {
            room.push_back(pair);
        }
    }
    ASSERT_LT(3 * room.size(), 2 * points.size());
    EXPECT_NEAR(pointVariance(points, start), pointVariance(room, start), 0.1);
}

/** Nothing is measured along an edge, so nothing can disagree there. */
TEST(PointVariance, onEdgesIsThatOfTheNoiseToo)
{
    test::PairWorld w = test::moved(64, 600, 0);
    std::vector<PointPair> points = w.drawPoints(2);
    for (size_t i = 0; i < points.size(); ++i)
    {
        const double angle = static_cast<double>(i);
        const Eigen::Vector3d along(std::cos(angle), std::sin(angle), 0);
        points[i].cur.cov += 100 * along * along.transpose();
        points[i].directions = 1;
    }
    EXPECT_NEAR(pointVariance(points, {w.T_prev_cur, Vector6d::Zero()}), 4, 0.6);
}

TEST(PointVariance, noPointsTellNone) { EXPECT_EQ(pointVariance({}, {}), 0); }
}  // namespace pointplane
