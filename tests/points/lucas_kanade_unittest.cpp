// SPDX-License-Identifier: BSD-3-Clause
#include "lucas_kanade.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "texture.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kCols = 161, kRows = 120, kMaxLevel = 2;

cv::Mat image(double du, double dv, unsigned seed)
{
    const test::Texture texture(1, 5, 40);
    test::GaussianSampler random(seed);
    return test::renderImage(
        kCols, kRows, [&](double u, double v) { return texture(u - du, v - dv); }, 1.5, &random);
}

std::vector<cv::Mat> pyramid(const cv::Mat& gray, int windowPx, bool withDerivatives)
{
    std::vector<cv::Mat> out;
    cv::buildOpticalFlowPyramid(gray, out, {windowPx, windowPx}, kMaxLevel, withDerivatives);
    return out;
}

/** Positions all over the image, whole pixels and others. */
std::vector<cv::Point2f> positions()
{
    std::vector<cv::Point2f> out;
    for (float v = 2; v < kRows; v += 9.25F)
    {
        for (float u = 2; u < kCols; u += 7.5F)
        {
            out.emplace_back(u, v);
        }
    }
    return out;
}

class LucasKanade : public testing::TestWithParam<int>
{
};

TEST_P(LucasKanade, AgreesWithOpenCvToTheBit)
{
    const int window = GetParam();
    cv::Mat first = image(0, 0, 1), second = image(2.3, -1.6, 2);
    first(cv::Rect(20, 30, 50, 50)).setTo(90);  // no structure
    const std::vector<cv::Mat> from = pyramid(first, window, true);
    const std::vector<cv::Mat> to = pyramid(second, window, false);
    const std::vector<cv::Point2f> points = positions();
    std::vector<cv::Point2f> expected = points;
    std::vector<uchar> found;
    const PatchSearch search{kMaxLevel + 1, 10, 0.03};
    cv::calcOpticalFlowPyrLK(
        from,
        to,
        points,
        expected,
        found,
        cv::noArray(),
        {window, window},
        kMaxLevel,
        {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, search.maxIterations, search.epsilon_px},
        cv::OPTFLOW_USE_INITIAL_FLOW);
    PatchTemplates templates(window);
    for (const cv::Point2f& point : points)
    {
        templates.add(from, point, Brightness::Constant);
    }
    int numFound = 0;
    for (size_t i = 0; i < points.size(); ++i)
    {
        cv::Point2f position = points[i];
        const bool isFound = templates.find(i, to, search, position);
        EXPECT_EQ(isFound, found[i] != 0) << points[i];
        EXPECT_EQ(position, expected[i]) << points[i];
        numFound += isFound ? 1 : 0;
    }
    EXPECT_GT(numFound, 100);
    if (window < 30)  // fits into the area without structure
    {
        EXPECT_LT(numFound, static_cast<int>(points.size()));
    }
}

INSTANTIATE_TEST_SUITE_P(Windows, LucasKanade, testing::Values(5, 8, 11, 15, 16, 21, 63));

TEST(LucasKanadeTest, SolvesForAShiftOfBrightness)
{
    constexpr int kWindow = 15;
    const cv::Point2f shift(2.3F, -1.6F);
    const std::vector<cv::Mat> from = pyramid(image(0, 0, 1), kWindow, true);
    const PatchSearch search{kMaxLevel + 1, 20, 0.01};
    const auto rmsError = [&](Brightness brightness, int brighter)
    {
        const cv::Mat second = image(shift.x, shift.y, 2) + brighter;
        const std::vector<cv::Mat> to = pyramid(second, kWindow, false);
        PatchTemplates templates(kWindow);
        double sum = 0;
        size_t num = 0;
        for (float v = 20; v < kRows - 20; v += 5)
        {
            for (float u = 20; u < kCols - 20; u += 5)
            {
                templates.add(from, {u, v}, brightness);
                cv::Point2f position(u, v);
                EXPECT_TRUE(templates.find(num++, to, search, position));
                const cv::Point2f error = position - cv::Point2f(u, v) - shift;
                sum += error.ddot(error);
            }
        }
        return std::sqrt(sum / static_cast<double>(num));
    };
    EXPECT_LT(rmsError(Brightness::Constant, 0), 0.1);
    EXPECT_LT(rmsError(Brightness::Shifted, 0), 0.1);
    EXPECT_LT(rmsError(Brightness::Shifted, 30), 0.1);
    EXPECT_GT(rmsError(Brightness::Constant, 30), 0.3);
}

TEST(LucasKanadeTest, SearchesAsManyLevelsAsThereAre)
{
    constexpr int kWindow = 15;
    const cv::Mat gray = image(0, 0, 1);
    PatchTemplates templates(kWindow);
    templates.add(pyramid(gray, kWindow, true), {80, 60}, Brightness::Shifted);
    cv::Point2f position(81, 59);
    EXPECT_TRUE(templates.find(0, pyramid(gray, kWindow, false), {8, 20, 0.01}, position));
    EXPECT_NEAR(position.x, 80, 0.05);
    EXPECT_NEAR(position.y, 60, 0.05);
}
}  // namespace
}  // namespace pointplane
