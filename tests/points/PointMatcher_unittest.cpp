// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/points/PointMatcher.h>

#include <opencv2/core.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "monte_carlo.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

namespace
{
using Vector2d = Eigen::Vector2d;

/** A float descriptor of four numbers per value: distances are 2 |a - b|. */
cv::Mat floats(const std::vector<float>& values)
{
    cv::Mat out(static_cast<int>(values.size()), 4, CV_32FC1);
    for (int i = 0; i < out.rows; ++i)
    {
        out.row(i).setTo(values[static_cast<size_t>(i)]);
    }
    return out;
}

PointMatcher::TParams plain(double radius)
{
    PointMatcher::TParams params;
    params.searchRadiusPx = radius;
    params.maxRatio = 1;
    params.crossCheck = false;
    return params;
}

struct RandomFrame
{
    std::vector<Vector2d> uv_px;
    cv::Mat descriptors;
};

RandomFrame randomFrame(GaussianSampler& random, int count, int type, int cols)
{
    RandomFrame out;
    out.descriptors.create(count, cols, type);
    for (int i = 0; i < count; ++i)
    {
        out.uv_px.emplace_back(random.uniform(0, 640), random.uniform(0, 480));
        for (int k = 0; k < cols; ++k)
        {
            if (type == CV_8UC1)
            {
                out.descriptors.at<uint8_t>(i, k) = static_cast<uint8_t>(random.uniform(0, 256));
            }
            else
            {
                out.descriptors.at<float>(i, k) = static_cast<float>(random.normal());
            }
        }
    }
    return out;
}
}  // namespace

TEST(PointMatcher, nearestDescriptorInsideTheCircleByHand)
{
    // The best descriptor (5) lies outside of the circle; inside, 7 beats 9.
    const PointMatcher matcher(plain(10));
    const auto matches = matcher.match(
        {{100, 100}}, floats({5}), {{111, 100}, {104, 100}, {100, 109}}, floats({5, 9, 7}));
    ASSERT_EQ(matches.size(), 1u);
    EXPECT_EQ(matches[0].ref, 0);
    EXPECT_EQ(matches[0].cur, 2);
    EXPECT_FLOAT_EQ(matches[0].distance, 4);
}

/** k-NN over the image, then the circle: 9 is in the circle, but not one of the two nearest. */
TEST(PointMatcher, nearestOfTheImageInsideTheCircleByHand)
{
    PointMatcher::TParams params = plain(10);
    params.neighbours = 2;
    const std::vector<Vector2d> cur{{111, 100}, {104, 100}, {100, 111}};
    const auto two = PointMatcher(params).match({{100, 100}}, floats({5}), cur, floats({5, 9, 7}));
    EXPECT_TRUE(two.empty());
    params.neighbours = 3;
    const auto three =
        PointMatcher(params).match({{100, 100}}, floats({5}), cur, floats({5, 9, 7}));
    ASSERT_EQ(three.size(), 1u);
    EXPECT_EQ(three[0].cur, 1);
    params.neighbours = 100;  // more than there are
    EXPECT_EQ(
        PointMatcher(params).match({{100, 100}}, floats({5}), cur, floats({5, 9, 7})).size(), 1u);
    params.neighbours = -1;
    EXPECT_THROW(PointMatcher{params}, std::invalid_argument);
}

TEST(PointMatcher, circleNotSquare)
{
    EXPECT_TRUE(
        PointMatcher(plain(10)).match({{0, 0}}, floats({1}), {{8, 8}}, floats({1})).empty());
    EXPECT_EQ(
        PointMatcher(plain(10)).match({{0, 0}}, floats({1}), {{6, 8}}, floats({1})).size(), 1u);
}

TEST(PointMatcher, hammingCountsBits)
{
    cv::Mat ref(1, 32, CV_8UC1, cv::Scalar(0)), cur(1, 32, CV_8UC1, cv::Scalar(0));
    cur.at<uint8_t>(0, 3) = 0xF1;
    cur.at<uint8_t>(0, 31) = 0x80;
    const auto matches = PointMatcher(plain(5)).match({{1, 1}}, ref, {{2, 2}}, cur);
    ASSERT_EQ(matches.size(), 1u);
    EXPECT_EQ(matches[0].distance, 6);
}

TEST(PointMatcher, ratioTestDropsAmbiguousPoints)
{
    PointMatcher::TParams params = plain(10);
    params.maxRatio = 0.8;
    const PointMatcher matcher(params);
    const std::vector<Vector2d> cur{{1, 0}, {0, 1}};
    EXPECT_TRUE(matcher.match({{0, 0}}, floats({0}), cur, floats({9, 10})).empty());
    EXPECT_EQ(matcher.match({{0, 0}}, floats({0}), cur, floats({7, 10})).size(), 1u);
    EXPECT_EQ(matcher.match({{0, 0}}, floats({0}), {{1, 0}}, floats({9})).size(), 1u)
        << "a lone candidate has no rival";
    EXPECT_TRUE(matcher.match({{0, 0}}, floats({0}), cur, floats({0, 0})).empty())
        << "two perfect candidates";
}

TEST(PointMatcher, crossCheckWantsBothDirections)
{
    // ref 0 and ref 1 both prefer cur 0; cur 0 prefers ref 1; ref 0 gets nothing, not even cur 1.
    PointMatcher::TParams params = plain(10);
    params.crossCheck = true;
    const std::vector<Vector2d> ref{{0, 0}, {1, 0}}, cur{{0, 1}, {0, 2}};
    const auto matches = PointMatcher(params).match(ref, floats({2, 4}), cur, floats({5, 9}));
    ASSERT_EQ(matches.size(), 1u);
    EXPECT_EQ(matches[0].ref, 1);
    EXPECT_EQ(matches[0].cur, 0);
}

TEST(PointMatcher, neverTwiceTheSamePoint)
{
    GaussianSampler random(81);
    for (const bool crossCheck : {false, true})
    {
        PointMatcher::TParams params = plain(80);
        params.crossCheck = crossCheck;
        const RandomFrame a = randomFrame(random, 300, CV_8UC1, 4);
        const RandomFrame b = randomFrame(random, 100, CV_8UC1, 4);
        std::vector<char> used(100, 0);
        int lastRef = -1;
        for (const PointMatch& m :
             PointMatcher(params).match(a.uv_px, a.descriptors, b.uv_px, b.descriptors))
        {
            EXPECT_EQ(used[static_cast<size_t>(m.cur)]++, 0);
            EXPECT_GT(m.ref, lastRef);
            lastRef = m.ref;
        }
    }
}

TEST(PointMatcher, equalsBruteForce)
{
    GaussianSampler random(82);
    for (const int type : {CV_8UC1, CV_32FC1})
    {
        for (const double radius : {3.0, 40.0, 150.0, 2000.0})
        {
            const RandomFrame a = randomFrame(random, 120, type, 17);
            const RandomFrame b = randomFrame(random, 150, type, 17);
            PointMatcher::TParams params = plain(radius);
            params.crossCheck = true;
            const auto matches =
                PointMatcher(params).match(a.uv_px, a.descriptors, b.uv_px, b.descriptors);

            const auto distance = [&](int i, int j)
            {
                const auto ref = static_cast<size_t>(i), cur = static_cast<size_t>(j);
                if ((a.uv_px[ref] - b.uv_px[cur]).norm() > radius)
                {
                    return std::numeric_limits<double>::infinity();
                }
                return cv::norm(
                    a.descriptors.row(i),
                    b.descriptors.row(j),
                    type == CV_8UC1 ? cv::NORM_HAMMING : cv::NORM_L2);
            };
            // Ties (Hamming) make "nearest" ambiguous: check that no better pair exists.
            size_t unique = 0;
            for (int i = 0; i < 120; ++i)
            {
                int best = 0, count = 0;
                for (int j = 0; j < 150; ++j)
                {
                    best = distance(i, j) < distance(i, best) ? j : best;
                }
                for (int j = 0; j < 150; ++j)
                {
                    count += distance(i, j) <= distance(i, best) ? 1 : 0;
                }
                for (int k = 0; k < 120; ++k)
                {
                    count += distance(k, best) <= distance(i, best) ? 1 : 0;
                }
                unique += std::isfinite(distance(i, best)) && count == 2 ? 1 : 0;
            }
            EXPECT_GE(matches.size(), unique);
            for (const PointMatch& m : matches)
            {
                for (int j = 0; j < 150; ++j)
                {
                    EXPECT_GE(distance(m.ref, j), static_cast<double>(m.distance) - 1e-4);
                }
                for (int i = 0; i < 120; ++i)
                {
                    EXPECT_GE(distance(i, m.cur), static_cast<double>(m.distance) - 1e-4);
                }
            }
        }
    }
}

TEST(PointMatcher, leavesOutWhatHasNoPosition)
{
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(
        PointMatcher()
            .match({{nan, 3}, {inf, 3}, {1e300, 1}}, floats({1, 1, 1}), {{3, 3}}, floats({1}))
            .empty());
    EXPECT_TRUE(PointMatcher().match({}, {}, {{3, 3}}, floats({1})).empty());
    EXPECT_TRUE(PointMatcher().match({{3, 3}}, floats({1}), {}, {}).empty());
}

TEST(PointMatcher, inconsistentInputIsRefused)
{
    const cv::Mat binary(1, 4, CV_8UC1, cv::Scalar(0));
    EXPECT_THROW(
        (void)PointMatcher().match({{1, 1}}, floats({1}), {{1, 1}}, binary), std::invalid_argument);
    EXPECT_THROW(
        (void)PointMatcher().match({{1, 1}}, floats({1, 2}), {{1, 1}}, floats({1})),
        std::invalid_argument);
    PointMatcher::TParams params;
    for (const double radius : {0.0, 1e-10, 0.9, 1e5})
    {
        params.searchRadiusPx = radius;
        EXPECT_THROW(PointMatcher{params}, std::invalid_argument) << radius;
    }
    params = {};
    params.maxRatio = 1.5;
    EXPECT_THROW(PointMatcher{params}, std::invalid_argument);
}
