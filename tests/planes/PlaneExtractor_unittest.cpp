// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/planes/PlaneExtractor.h>
#include <pointplane/planes/PlaneFitter.h>

#include <Eigen/LU>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "matchers.h"
#include "synthetic_depth.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr double kSigma = 1.425e-3;

PlaneSet extract(
    const cv::Mat& depth, const PinholeCamera& camera, const PlaneExtractor::TParams& params = {})
{
    return PlaneExtractor(params, {}).extract(depth, camera);
}

/** Index of the found plane nearest to theta. */
int nearest(const PlaneSet& set, const Eigen::Vector3d& theta)
{
    int best = -1;
    double distance = 1e9;
    for (size_t i = 0; i < set.planes.size(); ++i)
    {
        const double d = (set.planes[i].plane_cam.theta_m - theta).norm();
        if (d < distance)
        {
            distance = d;
            best = static_cast<int>(i);
        }
    }
    return best;
}

void expectWellFormed(const PlaneSet& set, const cv::Mat& depth)
{
    EXPECT_EQ(set.labels.type(), CV_8UC1);
    EXPECT_EQ(set.labels.size(), depth.size());
    double largest = 0;
    if (!set.labels.empty())
    {
        cv::minMaxLoc(set.labels, nullptr, &largest);
    }
    EXPECT_LE(largest, static_cast<double>(set.planes.size()));
    for (size_t i = 0; i < set.planes.size(); ++i)
    {
        EXPECT_TRUE(isPositiveDefinite(set.planes[i].plane_cam.cov_m));
        EXPECT_GT(set.planes[i].numPixels, 0);
        EXPECT_GT(cv::countNonZero(set.labels == static_cast<double>(i + 1)), 0);
        EXPECT_TRUE(set.planes[i].readoutLever.allFinite());
    }
}

struct Size
{
    int width, height;
    double fySign;
};

class PlaneExtractorTest : public testing::TestWithParam<Size>
{
 protected:
    const PinholeCamera camera =
        test::kinectCamera(GetParam().width, GetParam().height, GetParam().fySign);
    test::GaussianSampler sampler{7};

    cv::Mat noisy(cv::Mat depth)
    {
        test::addInverseDepthNoise(depth, kSigma, sampler);
        return depth;
    }
    /** Left of a column of the image, given as a fraction: plane 0, else plane 1. */
    cv::Mat twoParts(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double fraction = 0.5)
    {
        return noisy(test::renderDepth(
            camera, {a, b}, [&](int u, int) { return u < fraction * camera.width ? 0 : 1; }));
    }
};
}  // namespace

/** A phone bends a wall smoothly by half a per cent of its distance; it is one plane, and as
 * uncertain as it is bent. */
TEST_P(PlaneExtractorTest, aWallBentByTheSensorIsOnePlane)
{
    DepthNoise noise;
    noise.sigmaInverseDepth = 1e-5;
    noise.sigmaDepth = 4e-4;
    noise.sigmaRelative = 5e-3;
    const Eigen::Vector3d theta = test::thetaThrough({0, 0, 0.7}, {0.3, 0.1, -0.9});
    int one = 0;
    double nees = 0;
    const int runs = 12;
    for (int run = 0; run < runs; ++run)
    {
        const double phaseX = sampler.uniform(0, 6), phaseY = sampler.uniform(0, 6);
        cv::Mat depth = test::renderDepth(camera, {theta}, [](int, int) { return 0; });
        for (int v = 0; v < depth.rows; ++v)
        {
            for (int u = 0; u < depth.cols; ++u)
            {
                const double bend = 5e-3 * (std::sin(phaseX + 9.0 * u / camera.width) +
                                            std::sin(phaseY + 7.0 * v / camera.height));
                float& z = depth.at<float>(v, u);
                z = static_cast<float>(
                    static_cast<double>(z) * (1 + bend) + 3e-4 * sampler.normal());
            }
        }
        const PlaneSet set = PlaneExtractor({}, noise).extract(depth, camera);
        ASSERT_FALSE(set.planes.empty());
        one +=
            set.planes.size() == 1 && set.planes[0].numPixels > 0.9 * camera.width * camera.height;
        const Eigen::Vector3d e = theta - set.planes[0].plane_cam.theta_m;
        nees += e.dot(set.planes[0].plane_cam.cov_m.inverse() * e) / (3 * runs);
    }
    EXPECT_EQ(one, runs);
    EXPECT_GT(nees, 0.1);
    EXPECT_LT(nees, 2);
}

TEST_P(PlaneExtractorTest, cornerOfThreePlanes)
{
    const auto thetas = test::cornerThetas();
    const cv::Mat depth = noisy(test::renderRoom(camera, thetas));
    const PlaneSet set = extract(depth, camera);
    expectWellFormed(set, depth);
    ASSERT_EQ(set.planes.size(), 3U);
    for (size_t k = 0; k < 3; ++k)
    {
        const int i = nearest(set, thetas[k]);
        const PlaneGaussian& plane = set.planes[static_cast<size_t>(i)].plane_cam;
        EXPECT_THAT(plane.theta_m, test::IsMatrixNear(thetas[k], 2e-3));
        const Eigen::Vector3d e = thetas[k] - plane.theta_m;
        EXPECT_LT(e.dot(plane.cov_m.inverse() * e), 16.3);  // 99.9 % of chi^2(3)
        // The labels cover the plane, and nothing but it.
        int truePixels = 0, found = 0, common = 0;
        for (int v = 0; v < depth.rows; ++v)
        {
            for (int u = 0; u < depth.cols; ++u)
            {
                const bool isTrue = test::nearestPlane(camera, thetas, u, v) == static_cast<int>(k);
                const bool isFound = set.labels.at<uchar>(v, u) == i + 1;
                truePixels += isTrue ? 1 : 0;
                found += isFound ? 1 : 0;
                common += isTrue && isFound ? 1 : 0;
            }
        }
        EXPECT_GT(common, 0.95 * truePixels);
        EXPECT_GT(common, 0.95 * found);
    }
    EXPECT_GE(set.planes[0].numPixels, set.planes[1].numPixels);
    EXPECT_GE(set.planes[1].numPixels, set.planes[2].numPixels);
}

TEST_P(PlaneExtractorTest, onePlane)
{
    const Eigen::Vector3d theta(0.15, -0.1, -0.6);
    const cv::Mat depth = twoParts(theta, theta);
    const PlaneSet set = extract(depth, camera);
    ASSERT_EQ(set.planes.size(), 1U);
    EXPECT_EQ(set.planes[0].numPixels, camera.width * camera.height);
    EXPECT_EQ(cv::countNonZero(set.labels), camera.width * camera.height);
    EXPECT_THAT(set.planes[0].plane_cam.theta_m, test::IsMatrixNear(theta, 3e-4));
}

TEST_P(PlaneExtractorTest, partsOfOnePlaneThatDoNotTouchAreJoined)
{
    const Eigen::Vector3d wall(0.1, 0.05, -0.4), column(0, 0, -0.8);
    const cv::Mat depth = noisy(test::renderDepth(
        camera,
        {wall, column},
        [&](int u, int) { return std::abs(u - camera.width / 2) < camera.width / 8 ? 1 : 0; }));
    EXPECT_EQ(extract(depth, camera).planes.size(), 2U);
    PlaneExtractor::TParams apart;
    apart.mergeCoplanarPlanes = false;
    EXPECT_EQ(extract(depth, camera, apart).planes.size(), 3U);
}

TEST_P(PlaneExtractorTest, planesAtASmallAngleStayApart)
{
    // Two walls that meet in the middle of the image at 2 m, 8 degrees apart.
    const double half = 4 * M_PI / 180;
    const Eigen::Vector3d edge(0, 0, 2);
    const PlaneSet set = extract(
        twoParts(
            test::thetaThrough(edge, {std::sin(half), 0, -std::cos(half)}),
            test::thetaThrough(edge, {-std::sin(half), 0, -std::cos(half)})),
        camera);
    EXPECT_EQ(set.planes.size(), 2U);
}

TEST_P(PlaneExtractorTest, stepOfAFewCentimetresStaysApart)
{
    // A cupboard door 4 cm before a wall at 1.5 m: 5 times the noise of a reading.
    const PlaneSet set = extract(twoParts({0, 0, -1 / 1.5}, {0, 0, -1 / 1.46}, 0.6), camera);
    ASSERT_EQ(set.planes.size(), 2U);
    EXPECT_NEAR(hessianForm(set.planes[0].plane_cam.theta_m).d, 1.5, 0.003);
    EXPECT_NEAR(hessianForm(set.planes[1].plane_cam.theta_m).d, 1.46, 0.003);
}

/** Nor do they if they are more than half of all, as on dark surfaces. */
TEST_P(PlaneExtractorTest, missingReadingsDoNotMatter)
{
    const auto thetas = test::cornerThetas();
    cv::Mat depth = noisy(test::renderRoom(camera, thetas));
    for (int i = 0; i < depth.rows * depth.cols * 9 / 10; ++i)
    {
        depth.at<float>(
            static_cast<int>(sampler.uniform(0, depth.rows)),
            static_cast<int>(sampler.uniform(0, depth.cols))) = i % 2 == 0 ? test::kNoDepth : 0.F;
    }
    const PlaneSet set = extract(depth, camera);
    expectWellFormed(set, depth);
    ASSERT_EQ(set.planes.size(), 3U);
    for (const Eigen::Vector3d& theta : thetas)
    {
        const int i = nearest(set, theta);
        EXPECT_THAT(
            set.planes[static_cast<size_t>(i)].plane_cam.theta_m, test::IsMatrixNear(theta, 2e-3));
    }
}

TEST_P(PlaneExtractorTest, nothingToSee)
{
    cv::Mat depth(camera.height, camera.width, CV_32FC1, cv::Scalar(test::kNoDepth));
    const auto expectNothing = [&]
    {
        const PlaneSet set = extract(depth, camera);
        expectWellFormed(set, depth);
        EXPECT_TRUE(set.planes.empty());
        EXPECT_EQ(cv::countNonZero(set.labels), 0);
    };
    expectNothing();
    depth.at<float>(camera.height / 2, camera.width / 2) = 1.5F;
    expectNothing();
    depth.setTo(0);
    expectNothing();
    for (int v = 0; v < depth.rows; ++v)
    {
        for (int u = 0; u < depth.cols; ++u)
        {
            depth.at<float>(v, u) = static_cast<float>(sampler.uniform(0.5, 8));
        }
    }
    expectNothing();
}

TEST_P(PlaneExtractorTest, byRansacAndThePapersWeights)
{
    const auto thetas = test::cornerThetas();
    const cv::Mat depth = noisy(test::renderRoom(camera, thetas));
    PlaneExtractor::TParams params;
    params.ransac = true;
    params.fitWeights = "sigmaZ";
    const PlaneSet set = extract(depth, camera, params);
    expectWellFormed(set, depth);
    ASSERT_EQ(set.planes.size(), 3U);
    for (const Eigen::Vector3d& theta : thetas)
    {
        const int i = nearest(set, theta);
        EXPECT_THAT(
            set.planes[static_cast<size_t>(i)].plane_cam.theta_m, test::IsMatrixNear(theta, 5e-3));
    }
}

/** Every 101st pixel 3 % too far: RANSAC takes it out of the segment, not only out of the fit. */
TEST_P(PlaneExtractorTest, segmentsAreTheInliersOfRansac)
{
    const Eigen::Vector3d theta(0.1, 0.05, -0.6);
    cv::Mat depth = twoParts(theta, theta);
    const auto isOutlier = [&](int u, int v) { return (v * depth.cols + u) % 101 == 0; };
    for (int v = 0; v < depth.rows; ++v)
    {
        for (int u = 0; u < depth.cols; ++u)
        {
            depth.at<float>(v, u) *= isOutlier(u, v) ? 1.03F : 1;
        }
    }
    PlaneExtractor::TParams params;
    params.ransac = true;
    const PlaneSet set = extract(depth, camera, params);
    ASSERT_EQ(set.planes.size(), 1U);
    EXPECT_EQ(cv::countNonZero(set.labels), set.planes[0].numPixels);
    int inside = 0, wrong = 0;
    for (int v = 0; v < depth.rows; ++v)
    {
        for (int u = 0; u < depth.cols; ++u)
        {
            const bool isLabelled = set.labels.at<uchar>(v, u) != 0;
            inside += isLabelled ? 1 : 0;
            wrong += isLabelled && isOutlier(u, v) ? 1 : 0;
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(inside, 0.9 * static_cast<double>(depth.total()));
}

/** [P17 Eq. 3 to 5], each inlier of RANSAC counting by itself. */
TEST_P(PlaneExtractorTest, thePapersPlaneIsTheFitToItsSegment)
{
    const cv::Mat depth = noisy(test::renderRoom(camera, test::cornerThetas()));
    PlaneExtractor::TParams params;
    params.ransac = true;
    params.fitWeights = "sigmaZ";
    params.correlatedPixels = 1;
    params.mergeCoplanarPlanes = false;
    const PlaneSet set = extract(depth, camera, params);
    ASSERT_EQ(set.planes.size(), 3U);
    for (size_t k = 0; k < set.planes.size(); ++k)
    {
        std::vector<Eigen::Vector3d> segment;
        for (int v = 0; v < depth.rows; ++v)
        {
            for (int u = 0; u < depth.cols; ++u)
            {
                if (set.labels.at<uchar>(v, u) == k + 1)
                {
                    segment.emplace_back(
                        static_cast<double>(depth.at<float>(v, u)) * test::pixelRay(camera, u, v));
                }
            }
        }
        EXPECT_EQ(set.planes[k].numPixels, static_cast<int>(segment.size()));
        const auto expected = fitWeightedLeastSquares(segment, {});
        ASSERT_TRUE(expected);
        const PlaneGaussian& plane = set.planes[k].plane_cam;
        EXPECT_THAT(plane.theta_m, test::IsMatrixNear(expected->theta_m, 1e-9));
        EXPECT_LT(test::whitenedDifference(plane.cov_m, expected->cov_m), 1e-6);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Cameras,
    PlaneExtractorTest,
    testing::Values(Size{640, 480, 1}, Size{320, 240, 1}, Size{640, 480, -1}),
    [](const auto& size)
    { return std::to_string(size.param.width) + (size.param.fySign < 0 ? "yUp" : ""); });

TEST(PlaneExtractor, sameDepthGivesTheSameBits)
{
    const PinholeCamera camera = test::kinectCamera(320, 240);
    test::GaussianSampler sampler(8);
    cv::Mat depth = test::renderRoom(camera, test::cornerThetas());
    test::addInverseDepthNoise(depth, kSigma, sampler);
    PlaneExtractor::TParams params;
    params.ransac = true;
    PlaneExtractor used(params, {});
    (void)used.extract(cv::Mat(240, 320, CV_32FC1, cv::Scalar(1.3)), camera);
    const PlaneSet a = used.extract(depth, camera), b = extract(depth, camera, params);
    ASSERT_EQ(a.planes.size(), b.planes.size());
    EXPECT_EQ(std::memcmp(a.labels.data, b.labels.data, a.labels.total()), 0);
    for (size_t i = 0; i < a.planes.size(); ++i)
    {
        EXPECT_EQ(a.planes[i].plane_cam.theta_m, b.planes[i].plane_cam.theta_m);
        EXPECT_EQ(a.planes[i].plane_cam.cov_m, b.planes[i].plane_cam.cov_m);
    }
}

/** The whole chain, not the fit alone: which pixels belong is decided from the same noise. */
TEST(PlaneExtractor, covarianceIsThatOfMonteCarlo)
{
    const PinholeCamera camera = test::kinectCamera(160, 120);
    const auto thetas = test::cornerThetas();
    const cv::Mat clean = test::renderRoom(camera, thetas);
    test::GaussianSampler sampler(9);
    PlaneExtractor::TParams params;
    params.correlatedPixels = 1;  // as they are here
    PlaneExtractor extractor(params, {});
    double nees = 0;
    int n = 0;
    for (int run = 0; run < 150; ++run)
    {
        cv::Mat depth = clean.clone();
        test::addInverseDepthNoise(depth, kSigma, sampler);
        const PlaneSet set = extractor.extract(depth, camera);
        for (const Eigen::Vector3d& theta : thetas)
        {
            const int i = nearest(set, theta);
            ASSERT_GE(i, 0);
            const PlaneGaussian& plane = set.planes[static_cast<size_t>(i)].plane_cam;
            const Eigen::Vector3d e = theta - plane.theta_m;
            nees += e.dot(plane.cov_m.inverse() * e) / 3;
            ++n;
        }
    }
    // 1 +- 0.12 (3 sigma) for the fit; cells at the edges that are taken in whole add a little.
    EXPECT_GT(nees / n, 0.8);
    EXPECT_LT(nees / n, 1.3);
}

TEST(PlaneExtractor, correlatedPixelsWidenTheCovariance)
{
    const PinholeCamera camera = test::kinectCamera(320, 240);
    const cv::Mat depth(240, 320, CV_32FC1, cv::Scalar(1.5));
    PlaneExtractor::TParams params;
    params.correlatedPixels = 1;
    const PlaneSet one = extract(depth, camera, params);
    params.correlatedPixels = 36;
    const PlaneSet many = extract(depth, camera, params);
    ASSERT_EQ(one.planes.size(), 1U);
    ASSERT_EQ(many.planes.size(), 1U);
    EXPECT_TRUE(many.planes[0].plane_cam.cov_m.isApprox(36 * one.planes[0].plane_cam.cov_m, 1e-12));
}

TEST(PlaneExtractor, imagesSmallerThanACell)
{
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(9, 9), cv::Size(3, 50), cv::Size(25, 11)})
    {
        const PinholeCamera camera = test::kinectCamera(size.width, size.height);
        const cv::Mat depth(size, CV_32FC1, cv::Scalar(2));
        expectWellFormed(extract(depth, camera), depth);
    }
}

TEST(PlaneExtractor, refusesParametersOutOfRange)
{
    const auto refused = [](auto change)
    {
        PlaneExtractor::TParams params;
        change(params);
        EXPECT_THROW(PlaneExtractor(params, {}), std::invalid_argument);
    };
    refused([](auto& p) { p.cellSizePx = 2; });
    refused([](auto& p) { p.minValidFraction = 0; });
    refused([](auto& p) { p.minPlaneFraction = 2; });
    refused([](auto& p) { p.cellSigmas = 0; });
    refused([](auto& p) { p.mergeSigmas = -1; });
    refused([](auto& p) { p.stepSigmas = 0; });
    refused([](auto& p) { p.slopePx = -1; });
    refused([](auto& p) { p.correlatedPixels = -1; });
    refused([](auto& p) { p.fitWeights = "some"; });
}
}  // namespace pointplane
