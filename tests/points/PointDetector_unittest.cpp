// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/points/PointDetector.h>
#include <pointplane/points/PointMatcher.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "monte_carlo.h"
#include "texture.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

namespace
{
using Vector2d = Eigen::Vector2d;

constexpr int kWidth = 320, kHeight = 240;

/** Bright and dark discs and squares of many sizes: corners and blobs at known positions relative
 * to each other, whatever the shift. */
cv::Mat clutter(const Vector2d& shift, double noise, unsigned seed = 7)
{
    GaussianSampler layout(seed), random(seed + 1);
    constexpr int kFine = 8;  // drawn enlarged, then averaged: sub-pixel positions are exact
    cv::Mat big(kHeight * kFine, kWidth * kFine, CV_8UC1, cv::Scalar(110));
    for (int i = 0; i < 220; ++i)
    {
        const Vector2d p(layout.uniform(-20, kWidth + 20), layout.uniform(-20, kHeight + 20));
        const double half = layout.uniform(3, 12);
        const auto grey = layout.uniform(20, 240);
        const cv::Point2d c(kFine * (p.x() + shift.x()), kFine * (p.y() + shift.y()));
        const cv::Point2d h(kFine * half, kFine * half * layout.uniform(0.5, 1));
        if (layout.uniform() < 0.5)
        {
            cv::rectangle(big, cv::Point(c - h), cv::Point(c + h), cv::Scalar(grey), -1);
        }
        else
        {
            cv::circle(big, cv::Point(c), static_cast<int>(h.x), cv::Scalar(grey), -1);
        }
    }
    cv::Mat image;
    cv::resize(big, image, cv::Size(kWidth, kHeight), 0, 0, cv::INTER_AREA);
    for (int v = 0; v < kHeight; ++v)
    {
        for (int u = 0; u < kWidth; ++u)
        {
            uint8_t& pixel = image.at<uint8_t>(v, u);
            pixel = cv::saturate_cast<uint8_t>(pixel + noise * random.normal());
        }
    }
    return image;
}

PointDetector::TParams paramsOf(const std::string& detector)
{
    PointDetector::TParams params;
    params.detector = detector;
    return params;
}

class EachDetector : public testing::TestWithParam<std::string>
{
};
}  // namespace

INSTANTIATE_TEST_SUITE_P(
    PointDetector,
    EachDetector,
    testing::Values("surf", "orb", "akaze", "sift", "fast"),
    [](const auto& instance) { return instance.param; });

TEST_P(EachDetector, findsPointsAgainAfterASubPixelShift)
{
    const Vector2d shift(4.375, -2.625);
    const PointDetector detector(paramsOf(GetParam()));
    const DetectedPoints a = detector.detect(clutter({0, 0}, 2, 7));
    const DetectedPoints b = detector.detect(clutter(shift, 2, 7));
    ASSERT_GT(a.uv_px.size(), 60u);
    ASSERT_EQ(a.descriptors.rows, static_cast<int>(a.uv_px.size()));

    PointMatcher::TParams matching;
    matching.searchRadiusPx = 20;
    matching.maxRatio = 0.8;
    int right = 0;
    double squared = 0;
    const auto matches =
        PointMatcher(matching).match(a.uv_px, a.descriptors, b.uv_px, b.descriptors);
    for (const PointMatch& m : matches)
    {
        const Vector2d error =
            b.uv_px[static_cast<size_t>(m.cur)] - a.uv_px[static_cast<size_t>(m.ref)] - shift;
        if (error.norm() < 2)
        {
            ++right;
            squared += error.squaredNorm();
        }
    }
    // FAST fires on pixels, SURF, AKAZE and SIFT interpolate a scale space.
    const bool isCornerDetector = GetParam() == "orb" || GetParam() == "fast";
    EXPECT_GT(right, 0.35 * static_cast<double>(a.uv_px.size())) << "found again";
    EXPECT_GT(right, 0.85 * static_cast<double>(matches.size())) << "of the matches";
    EXPECT_LT(std::sqrt(squared / right / 2), isCornerDetector ? 0.7 : 0.4) << "px";
}

TEST_P(EachDetector, sameResultWithAnyNumberOfThreads)
{
    const cv::Mat image = clutter({0, 0}, 2);
    const PointDetector detector(paramsOf(GetParam()));
    const int before = cv::getNumThreads();
    cv::setNumThreads(1);
    const DetectedPoints one = detector.detect(image);
    cv::setNumThreads(4);
    const DetectedPoints four = PointDetector(paramsOf(GetParam())).detect(image);
    cv::setNumThreads(before);
    ASSERT_EQ(one.uv_px, four.uv_px);
    EXPECT_EQ(cv::norm(one.descriptors, four.descriptors, cv::NORM_INF), 0);
}

TEST_P(EachDetector, keepsTheMostAndSpreadsThem)
{
    // Strong texture on the left, a faint copy on the right: both halves get their share.
    cv::Mat image = clutter({0, 0}, 0);
    cv::Mat right = image.colRange(kWidth / 2, kWidth);
    right.convertTo(right, CV_8U, 0.6, 50);
    PointDetector::TParams params = paramsOf(GetParam());
    params.maxPoints = 60;
    const DetectedPoints points = PointDetector(params).detect(image);
    EXPECT_LE(points.uv_px.size(), 60u);
    EXPECT_GT(points.uv_px.size(), 50u);
    const auto onRight = std::count_if(
        points.uv_px.begin(),
        points.uv_px.end(),
        [](const Vector2d& p) { return p.x() > kWidth / 2; });
    EXPECT_GT(onRight, 15);
}

TEST_P(EachDetector, nothingToSeeIsNoError)
{
    const PointDetector detector(paramsOf(GetParam()));
    EXPECT_TRUE(detector.detect(cv::Mat()).uv_px.empty());
    EXPECT_TRUE(detector.detect(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128))).uv_px.empty());
    EXPECT_TRUE(detector.detect(cv::Mat(24, 24, CV_8UC1, cv::Scalar(128))).uv_px.empty());
    EXPECT_THROW((void)detector.detect(cv::Mat(240, 320, CV_8UC3)), std::invalid_argument);
}

TEST_P(EachDetector, worksOnARealFrame)
{
    const char* data = std::getenv("POINTPLANE_DATA");
    if (data == nullptr)
    {
        GTEST_SKIP() << "POINTPLANE_DATA is not set";
    }
    std::vector<cv::String> files;
    cv::glob(std::string(data) + "/tum_fr1_xyz_part/rgb", files);
    ASSERT_GT(files.size(), 101u);
    const PointDetector detector(paramsOf(GetParam()));
    const DetectedPoints a = detector.detect(cv::imread(files[100], cv::IMREAD_GRAYSCALE));
    const DetectedPoints b = detector.detect(cv::imread(files[101], cv::IMREAD_GRAYSCALE));
    EXPECT_GT(a.uv_px.size(), 300u);
    const auto matches = PointMatcher().match(a.uv_px, a.descriptors, b.uv_px, b.descriptors);
    EXPECT_GT(matches.size(), 120u);
}

TEST(PointDetector, surfDescriptorsHaveUnitLength)
{
    for (const bool upright : {true, false})
    {
        PointDetector::TParams params = paramsOf("surf");
        params.upright = upright;
        const DetectedPoints points = PointDetector(params).detect(clutter({0, 0}, 2));
        ASSERT_GT(points.descriptors.rows, 20);
        EXPECT_EQ(points.descriptors.cols, 64);
        for (int i = 0; i < points.descriptors.rows; ++i)
        {
            EXPECT_NEAR(cv::norm(points.descriptors.row(i)), 1, 1e-5);
        }
    }
}

TEST(PointDetector, orientedSurfSurvivesAQuarterTurn)
{
    const cv::Mat image = clutter({0, 0}, 2);
    cv::Mat turned;
    cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);
    std::array<double, 2> rightShare{};
    for (const bool upright : {false, true})
    {
        PointDetector::TParams params = paramsOf("surf");
        params.upright = upright;
        const PointDetector detector(params);
        const DetectedPoints a = detector.detect(image), b = detector.detect(turned);
        std::vector<Vector2d> predicted;
        for (const Vector2d& p : a.uv_px)
        {
            predicted.emplace_back(kHeight - 1 - p.y(), p.x());
        }
        int right = 0;
        for (const PointMatch& m :
             PointMatcher().match(predicted, a.descriptors, b.uv_px, b.descriptors))
        {
            const auto ref = static_cast<size_t>(m.ref), cur = static_cast<size_t>(m.cur);
            right += (predicted[ref] - b.uv_px[cur]).norm() < 2 ? 1 : 0;
        }
        rightShare[upright ? 1 : 0] = right / static_cast<double>(a.uv_px.size());
    }
    EXPECT_GT(rightShare[0], 0.4);
    EXPECT_LT(rightShare[1], 0.2);
}

/** OpenCV halves an image until nothing is left, and throws. */
TEST(PointDetector, imagesOfOneRowOrColumnHaveNoPoint)
{
    PointDetector::TParams params;
    for (const char* detector : {"surf", "orb", "akaze", "sift", "fast"})
    {
        params.detector = detector;
        const PointDetector points(params);
        for (const cv::Size size : {cv::Size(1, 1), cv::Size(1, 240), cv::Size(320, 1)})
        {
            cv::Mat gray(size, CV_8UC1);
            cv::randu(gray, 0, 255);
            EXPECT_TRUE(points.detect(gray).uv_px.empty()) << detector;
        }
    }
}

TEST(PointDetector, checkNamesTheKey)
{
    EXPECT_THROW(PointDetector{paramsOf("brisk")}, std::invalid_argument);
    PointDetector::TParams params;
    params.maxPoints = 0;
    EXPECT_THROW(PointDetector{params}, std::invalid_argument);
    params = {};
    params.gridCellPx = -3;
    EXPECT_THROW(PointDetector{params}, std::invalid_argument);
}
