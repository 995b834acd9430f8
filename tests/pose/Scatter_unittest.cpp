// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/PoseSolver.h>

#include <limits>
#include <utility>
#include <vector>

#include "synthetic_pairs.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kNumProblems = 100;

double scatterOf(const PoseProblem& problem)
{
    const PoseSolver solver(test::gaussianSolver());
    return solver.analyse(problem, solver.solve(problem, {})).scatter;
}

/** Mean of points and planes with so many times the claimed noise. */
double meanScatter(unsigned seed, double noise, bool hasPoints, bool hasPlanes, int numPlanes = 12)
{
    test::PairWorld w = test::moved(seed, 200, numPlanes);
    double sum = 0;
    for (int run = 0; run < kNumProblems; ++run)
    {
        const auto points = w.drawPoints(noise);
        const auto planes = w.drawPlanes(noise);
        sum += scatterOf(test::atRest(
            hasPoints ? points : std::vector<PointPair>(),
            hasPlanes ? planes : std::vector<PlanePair>()));
    }
    return sum / kNumProblems;
}

/** Points to the upper left and lower right are off one way, the others the other way: no motion
 * explains that. */
double saddle(const Eigen::Vector3d& p) { return p.x() * p.y() > 0 ? 1 : -1; }
}  // namespace

/** A residual is the noise of two features, the reference's and the current one's, less the part
 * that the solution follows. */
TEST(Scatter, ofNoiseIsTheVarianceOfTheResiduals)
{
    EXPECT_NEAR(meanScatter(91, 1, true, true), 2, 0.35);
    EXPECT_NEAR(meanScatter(92, 1, true, false), 2, 0.35);
    EXPECT_NEAR(meanScatter(93, 1, false, true, 60), 2, 0.35);
    EXPECT_NEAR(meanScatter(93, 1, false, true), 1, 0.3) << "twelve follow half of their noise";
}

TEST(Scatter, growsWithTheSquareOfTheNoise)
{
    EXPECT_NEAR(meanScatter(94, 3, true, true) / meanScatter(94, 1, true, true), 9, 0.1);
}

/** The residuals are as large, and their order tells them apart. */
TEST(Scatter, showsThatNeighboursErrTogether)
{
    test::PairWorld w = test::moved(95, 200, 12);
    std::vector<PointPair> together = w.drawPoints(0.1);
    std::vector<double> signs;
    for (const PointPair& pair : together)
    {
        signs.push_back(saddle(pair.cur.mean));
    }
    std::vector<PointPair> each = together;
    const auto displace = [](std::vector<PointPair>& pairs, const std::vector<double>& by)
    {
        for (size_t i = 0; i < pairs.size(); ++i)
        {
            const double focal = 525;
            pairs[i].cur.mean.x() += by[i] * pairs[i].cur.mean.z() / focal;
        }
    };
    displace(together, signs);
    std::vector<double> shuffled = signs;
    for (size_t i = 0; i < shuffled.size(); ++i)
    {
        std::swap(shuffled[i], shuffled[(i * 71) % shuffled.size()]);
    }
    displace(each, shuffled);
    EXPECT_GT(scatterOf(test::atRest(together, {})), 4 * scatterOf(test::atRest(each, {})));
}

/** Patches of one plane, seen from several references, are one part. */
TEST(Scatter, aPlaneIsOnePart)
{
    test::PairWorld w = test::moved(96, 200, 12);
    std::vector<PlanePair> planes = w.drawPlanes();
    for (size_t i = 0; i < planes.size(); ++i)
    {
        planes[i].feature = static_cast<int>(i);
    }
    const double once = scatterOf(test::atRest({}, planes));
    const std::vector<PlanePair> copy = planes;
    planes.insert(planes.end(), copy.begin(), copy.end());
    EXPECT_NEAR(scatterOf(test::atRest({}, planes)), once, 1e-3 * once);
}

/** Six parts can be brought to agree, right or wrong. */
TEST(Scatter, fewPartsTellNothing)
{
    test::PairWorld w(97);
    const PoseGaussian prior{{}, 1e-4 * Matrix6d::Identity()};
    EXPECT_EQ(scatterOf(test::atRest({}, {}, {}, prior)), 0);
    w.addPlanes(1);
    EXPECT_EQ(scatterOf(test::atRest({}, w.drawPlanes(), {}, prior)), 0);
    w.addPlanes(5);
    EXPECT_EQ(scatterOf(test::atRest({}, w.drawPlanes(), {}, prior)), 0);
    w.addPlanes(1);
    EXPECT_GT(scatterOf(test::atRest({}, w.drawPlanes(), {}, prior)), 0);
}

/** With it there would be seven parts, which tell something. */
TEST(Scatter, pairsThatAreNotFiniteAreNoParts)
{
    test::PairWorld w = test::moved(96, 1, 6);
    const std::vector<PlanePair> six = w.drawPlanes();
    const std::vector<PointPair> good = w.drawPoints();
    EXPECT_EQ(scatterOf(test::atRest({}, six)), 0);
    EXPECT_GT(scatterOf(test::atRest(good, six)), 0);
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    {
        std::vector<PointPair> point = good;
        point.front().cur.mean.z() = bad;
        EXPECT_EQ(scatterOf(test::atRest(point, six)), 0) << "a point with " << bad;
        std::vector<PlanePair> planes = six;
        planes.push_back(six.front());
        planes.back().cur.theta_m.z() = bad;
        EXPECT_EQ(scatterOf(test::atRest({}, planes)), 0) << "a plane with " << bad;
    }
}
}  // namespace pointplane
