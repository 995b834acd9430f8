// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneAligner.h"

#include <pointplane/core/se3.h>

#include <Eigen/LU>

#include <algorithm>
#include <optional>
#include <random>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Of frames that differ by any motion. */
class PlaneAlignerTest : public ::testing::Test
{
 protected:
    [[nodiscard]] Eigen::Vector3d randomVector()
    {
        return {normal_(random_), normal_(random_), normal_(random_)};
    }

    /** Planes around the camera, the largest first. */
    [[nodiscard]] PlaneSet randomPlanes(int number)
    {
        PlaneSet out;
        for (int i = 0; i < number; ++i)
        {
            add(out, {randomVector().normalized(), 2 + 0.3 * normal_(random_)}, 1000 - i);
        }
        return out;
    }

    static void add(PlaneSet& to, const Plane& plane, int numPixels)
    {
        PlaneFeature feature;
        feature.plane_cam.theta_m = minimalForm(plane);
        feature.numPixels = numPixels;
        to.planes.push_back(feature);
    }

    /** As a camera sees them that has moved; in any order. */
    [[nodiscard]] PlaneSet seen(const PlaneSet& planes, const Eigen::Isometry3d& T_cur_ref)
    {
        PlaneSet out;
        for (const PlaneFeature& plane : planes.planes)
        {
            const Plane moved = transformed(T_cur_ref, hessianForm(plane.plane_cam.theta_m));
            add(out, moved, plane.numPixels);
        }
        std::shuffle(out.planes.begin(), out.planes.end(), random_);
        return out;
    }

    [[nodiscard]] Eigen::Isometry3d randomMotion(double translation = 0.5, double rotation = 0.8)
    {
        Vector6d xi;
        xi << translation * randomVector(), rotation * randomVector();
        return se3Exp(xi);
    }

    static double distance(
        const std::vector<Eigen::Isometry3d>& motions, const Eigen::Isometry3d& truth)
    {
        double out = 1e9;
        for (const Eigen::Isometry3d& T : motions)
        {
            out = std::min(out, se3Log(T * truth.inverse()).norm());
        }
        return out;
    }

    /** By plane i of ref and plane order[i] of cur; nothing if they differ by more than a degree,
     * or tell a motion badly. */
    [[nodiscard]] static std::optional<Eigen::Isometry3d> laidOver(
        const PlaneSet& ref, const PlaneSet& cur, const std::vector<size_t>& order)
    {
        Eigen::Matrix3d before, now;
        Eigen::Vector3d way;
        for (int i = 0; i < 3; ++i)
        {
            const auto k = static_cast<size_t>(i);
            const Plane a = hessianForm(ref.planes[k].plane_cam.theta_m);
            const Plane b = hessianForm(cur.planes[order[k]].plane_cam.theta_m);
            before.col(i) = a.n;
            now.col(i) = b.n;
            way[i] = a.d - b.d;
        }
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = nearestRotation(now * before.transpose());
        const double leastCosine =
            (T.linear() * before).cwiseProduct(now).colwise().sum().minCoeff();
        if (std::abs(now.determinant()) < 0.5 || leastCosine < std::cos(0.0175))
        {
            return {};
        }
        T.translation() = now.transpose().inverse() * way;
        return T;
    }

    std::mt19937 random_{7};
    std::normal_distribution<double> normal_;
    PlaneAligner aligner_{PlaneMatcher::TParams{}};
};
}  // namespace

/** Planes that are nearly parallel tell a motion badly, so not every draw of three tells one. */
TEST_F(PlaneAlignerTest, exactPlanesAllowTheTrueMotion)
{
    int numFound = 0;
    for (int k = 0; k < 100; ++k)
    {
        const PlaneSet ref = randomPlanes(4);
        const Eigen::Isometry3d truth = randomMotion();
        numFound += distance(aligner_.motions(ref, seen(ref, truth), {}), truth) < 1e-9 ? 1 : 0;
    }
    EXPECT_GE(numFound, 95);
}

/** All six ways to lay three planes over three others are tried. */
TEST_F(PlaneAlignerTest, agreesWithBruteForce)
{
    int numRigid = 0;
    for (int k = 0; k < 100; ++k)
    {
        const PlaneSet ref = randomPlanes(3), cur = seen(ref, randomMotion());
        const auto found = aligner_.motions(ref, cur, {});
        std::vector<size_t> order{0, 1, 2};
        do
        {
            const auto T = laidOver(ref, cur, order);
            numRigid += T ? 1 : 0;
            EXPECT_TRUE(
                !T || std::any_of(
                          found.begin(),
                          found.end(),
                          [&](const auto& other) { return aligner_.areAlike(*T, other); }))
                << k;
        } while (std::next_permutation(order.begin(), order.end()));
    }
    EXPECT_GE(numRigid, 30);
}

/** Which wall of a box is which cannot be told: three turns about its diagonal fit. */
TEST_F(PlaneAlignerTest, aCornerFitsInThreeWays)
{
    PlaneSet ref;
    for (int axis = 0; axis < 3; ++axis)
    {
        add(ref, {Eigen::Vector3d::Unit(axis), 2}, 100);
    }
    EXPECT_EQ(aligner_.motions(ref, ref, {}).size(), 3U);
}

TEST_F(PlaneAlignerTest, twoPlanesNeedAPoint)
{
    const PlaneSet two = []
    {
        PlaneSet out;
        add(out, {Eigen::Vector3d::UnitX(), 1}, 100);
        add(out, {Eigen::Vector3d(1, 2, 0).normalized(), 2}, 90);
        return out;
    }();
    const Eigen::Isometry3d truth = randomMotion(0.3, 0.3);
    const PlaneSet cur = seen(two, truth);
    EXPECT_TRUE(aligner_.motions(two, cur, {}).empty());
    MatchedPoints points;
    points.ref = {{0.3, 0.2, 2}, {-0.5, 0.1, 1.5}};
    points.cur = {truth * points.ref[0], {5, 5, 5}};  // the second one is wrong
    EXPECT_LT(distance(aligner_.motions(two, cur, points), truth), 1e-9);
}

TEST_F(PlaneAlignerTest, parallelPlanesTellNothing)
{
    PlaneSet walls;
    add(walls, {Eigen::Vector3d::UnitX(), 1}, 100);
    add(walls, {-Eigen::Vector3d::UnitX(), 1}, 100);
    add(walls, {Eigen::Vector3d(1, 0.05, 0).normalized(), 2}, 100);
    EXPECT_TRUE(aligner_.motions(walls, walls, {}).empty());
}

/** Their normals are half a degree off, by noise: that must not be taken for a turn. */
TEST_F(PlaneAlignerTest, wallsThatFaceEachOtherTellNoTurn)
{
    PlaneSet walls;
    add(walls, {Eigen::Vector3d::UnitX(), 1}, 100);
    add(walls, {Eigen::Vector3d(-1, 0.01, 0).normalized(), 1}, 90);
    MatchedPoints points;
    points.ref = points.cur = {{0.2, 0.3, 2}};
    EXPECT_TRUE(aligner_.motions(walls, walls, points).empty());
}

/** Standard deviations of a wall at 2 m: 5 mm and half a degree. */
TEST_F(PlaneAlignerTest, noiseMovesItALittle)
{
    PlaneSet ref;
    add(ref, {Eigen::Vector3d::UnitX(), 2}, 100);
    add(ref, {Eigen::Vector3d(0.3, 1, 0).normalized(), 1.5}, 90);
    add(ref, {Eigen::Vector3d(0.2, -0.4, -1).normalized(), 3}, 80);
    for (int k = 0; k < 50; ++k)
    {
        const Eigen::Isometry3d truth = randomMotion();
        PlaneSet noisy;
        for (const PlaneFeature& feature : seen(ref, truth).planes)
        {
            Plane plane = hessianForm(feature.plane_cam.theta_m);
            plane.n = (plane.n + 0.009 * randomVector()).normalized();
            plane.d += 0.005 * normal_(random_);
            add(noisy, plane, feature.numPixels);
        }
        EXPECT_LT(distance(aligner_.motions(ref, noisy, {}), truth), 0.15) << k;
    }
}
}  // namespace pointplane
