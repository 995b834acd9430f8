// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneClustering.h>

#include <algorithm>
#include <set>
#include <vector>

#include "matchers.h"
#include "synthetic_depth.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
const PinholeCamera kSmallCamera = test::kinectCamera(320, 240);

CellGrid gridOf(const cv::Mat& depth)
{
    CellGrid grid;
    grid.compute(depth, kSmallCamera, 10);
    return grid;
}

/** Two walls, left and right of a column. */
cv::Mat twoParts(const Eigen::Vector3d& left, const Eigen::Vector3d& right, int column = 160)
{
    test::GaussianSampler sampler(1);
    cv::Mat depth = test::renderDepth(
        kSmallCamera, {left, right}, [&](int u, int) { return u < column ? 0 : 1; });
    test::addInverseDepthNoise(depth, 1.425e-3, sampler);
    return depth;
}

std::vector<CellCluster> clusters(const cv::Mat& depth)
{
    return clusterCells(gridOf(depth), PlanarityTest{}, 0.7, 500);
}

PlaneMoments momentsOfDepth(const cv::Mat& depth)
{
    PlaneMoments out;
    for (const PlaneMoments& m : gridOf(depth).moments)
    {
        out += m;
    }
    return out;
}
}  // namespace

TEST(PlanarityTest, toleranceByHand)
{
    PlanarityTest test;
    test.noise.sigmaInverseDepth = 3e-3;
    test.slopePx = 2;
    test.focalLengthPx = 500;
    // Slope 1 per metre times 2/500.
    PlaneMoments pixels;
    pixels.add(0, 0, 5);
    pixels.add(0.1, 0, 5);
    EXPECT_NEAR(test.tolerated({0.6, 0.8, -5}, pixels, 1), 2 * (9e-6 + 16e-6), 1e-15);
    EXPECT_NEAR(test.tolerated({0, 0, -5}, pixels, 1), 2 * 9e-6, 1e-15);

    // What bends by 0.4 % is 2e-3 at 1/Z = 0.5 per metre: of 13e-6, 9e-6 remain where none of it is
    // seen.
    test.noise.sigmaRelative = 4e-3;
    PlaneMoments far;
    far.add(0, 0, 0.5, test.noise.weight(0.5));
    far.add(0.1, 0, 0.5, test.noise.weight(0.5));
    EXPECT_NEAR(test.noise.weight(0.5), 9.0 / 13, 1e-12);
    EXPECT_NEAR(test.tolerated({0, 0, -0.5}, far, 1), 2 * 9e-6, 1e-15);
    EXPECT_NEAR(test.tolerated({0, 0, -0.5}, far, 0), 2 * 9e-6 * 9 / 13, 1e-15);
    EXPECT_NEAR(test.tolerated({0.6, 0.8, -0.5}, far, 1), 2 * (9e-6 + 16e-6 * 9 / 13), 1e-15);
    test.bentPixels = 200;
    EXPECT_DOUBLE_EQ(test.bendWithin(100), 0.25);
    EXPECT_DOUBLE_EQ(test.bendWithin(300), 1);
}

TEST(PlanarityTest, cellsAndMergesAtTheirLimits)
{
    PlanarityTest test;
    test.noise.sigmaInverseDepth = 0.01;
    test.slopePx = 0;
    // Four pixels at +-e around a frontal plane, arranged so that no slope explains them.
    const auto cell = [](double e, double q)
    {
        PlaneMoments m;
        m.add(-1, -1, q + e);
        m.add(1, 1, q + e);
        m.add(-1, 1, q - e);
        m.add(1, -1, q - e);
        return m;
    };
    EXPECT_TRUE(test.isPlanarCell(cell(0.0249, 1)));
    EXPECT_FALSE(test.isPlanarCell(cell(0.0251, 1)));
    // Two exact cells, 2 delta apart: rms delta about the joint plane; step sigmas bind first:
    // 8 delta^2 <= 4 sigma^2 * 4.
    const auto merges = [&](double delta)
    { return test.merged(cell(0, 1 - delta), 0, cell(0, 1 + delta), 0).has_value(); };
    EXPECT_TRUE(merges(0.0141));
    EXPECT_FALSE(merges(0.0142));
    test.stepSigmas = 100;
    EXPECT_TRUE(merges(0.0199));
    EXPECT_FALSE(merges(0.0201));
}

/** The mean error alone would let a large plane swallow a small one. */
TEST(PlanarityTest, aLargePlaneDoesNotSwallowASmallOne)
{
    const Eigen::Vector3d wall(0, 0, -0.5), shelf(0, 0, -0.52);  // 7.4 cm nearer
    const PlaneMoments large = momentsOfDepth(twoParts(wall, wall));
    const PlaneMoments small = gridOf(twoParts(shelf, shelf)).moments[100];
    const auto a = fitPlane(large), b = fitPlane(small);
    ASSERT_TRUE(a && b);
    EXPECT_FALSE(PlanarityTest{}.merged(large, a->sse, small, b->sse));
    const PlaneMoments same = gridOf(twoParts(wall, wall)).moments[100];
    EXPECT_TRUE(PlanarityTest{}.merged(large, a->sse, same, fitPlane(same)->sse));
}

TEST(ClusterCells, oneWallIsOneClusterOfAllItsCells)
{
    const Eigen::Vector3d wall(0.1, 0.2, -0.5);
    const auto found = clusters(twoParts(wall, wall));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].moments.n, 320 * 240);
    EXPECT_EQ(found[0].cells.size(), 32U * 24U);
    EXPECT_THAT(found[0].fit.theta_m, test::IsMatrixNear(wall, 1e-3));
}

TEST(ClusterCells, partitionOfCells)
{
    const auto found = clusters(test::renderRoom(kSmallCamera, test::cornerThetas()));
    ASSERT_EQ(found.size(), 3U);
    std::set<int> all;
    for (const CellCluster& cluster : found)
    {
        double n = 0;
        for (const int cell : cluster.cells)
        {
            EXPECT_TRUE(all.insert(cell).second) << "cell " << cell << " twice";
            n += 100;
        }
        EXPECT_EQ(cluster.moments.n, n);
    }
    EXPECT_TRUE(std::is_sorted(
        found.begin(),
        found.end(),
        [](const auto& a, const auto& b) { return a.moments.n > b.moments.n; }));
}

TEST(ClusterCells, smallClustersAreDropped)
{
    // 30 columns of 240: 7200 pixels.
    const cv::Mat depth = twoParts({0, 0, -0.5}, {0, 0, -0.8}, 290);
    EXPECT_EQ(clusterCells(gridOf(depth), {}, 0.7, 7000).size(), 2U);
    EXPECT_EQ(clusterCells(gridOf(depth), {}, 0.7, 7400).size(), 1U);
}

TEST(ClusterCells, cellsWithGapsCountByTheirValidFraction)
{
    cv::Mat depth = twoParts({0, 0, -0.5}, {0, 0, -0.5});
    for (int v = 0; v < depth.rows; ++v)
    {
        for (int u = 0; u < depth.cols; ++u)
        {
            if ((u * 7 + v * 3) % 10 < 4)
            {
                depth.at<float>(v, u) = test::kNoDepth;  // 40 % of each row of a cell
            }
        }
    }
    EXPECT_EQ(clusterCells(gridOf(depth), {}, 0.55, 500).size(), 1U);
    EXPECT_TRUE(clusterCells(gridOf(depth), {}, 0.65, 500).empty());
}

TEST(ClusterCells, nothingInNothingOut)
{
    EXPECT_TRUE(clusterCells(CellGrid{}, {}, 0.7, 500).empty());
    EXPECT_TRUE(clusters(cv::Mat(240, 320, CV_32FC1, cv::Scalar(test::kNoDepth))).empty());
}

TEST(MergeCoplanar, joinsPartsOfOnePlaneOnly)
{
    // A wall behind a column, and the column.
    const Eigen::Vector3d wall(0.05, 0, -0.4), column(0, 0, -0.8);
    test::GaussianSampler sampler(2);
    cv::Mat depth = test::renderDepth(
        kSmallCamera, {wall, column}, [](int u, int) { return u >= 120 && u < 200 ? 1 : 0; });
    test::addInverseDepthNoise(depth, 1.425e-3, sampler);
    auto found = clusters(depth);
    ASSERT_EQ(found.size(), 3U);
    mergeCoplanar(found, {});
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].moments.n, 240 * 240);
    EXPECT_EQ(found[0].cells.size(), 24U * 24U);
    EXPECT_THAT(found[0].fit.theta_m, test::IsMatrixNear(wall, 1e-3));
    EXPECT_THAT(found[1].fit.theta_m, test::IsMatrixNear(column, 1e-3));
}
}  // namespace pointplane
