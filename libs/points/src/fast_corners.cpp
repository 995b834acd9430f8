// SPDX-License-Identifier: BSD-3-Clause
#include "fast_corners.h"

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr int kFastRadiusPx = 3;
constexpr int kMinThreshold = 5;
constexpr float kMaxRefinementPx = 1.5F;

/** Smaller eigenvalue of the structure tensor over 7x7 pixels (Shi & Tomasi 1994), per pixel
 * [grey^2/px^2]: how well the corner can be located, which FAST's own score does not tell. */
float cornerStrength(const cv::Mat& gray, int u, int v)
{
    int xx = 0, xy = 0, yy = 0;
    for (int y = v - 3; y <= v + 3; ++y)
    {
        const uint8_t* above = gray.ptr<uint8_t>(y - 1);
        const uint8_t* row = gray.ptr<uint8_t>(y);
        const uint8_t* below = gray.ptr<uint8_t>(y + 1);
        for (int x = u - 3; x <= u + 3; ++x)
        {
            const int gx = row[x + 1] - row[x - 1], gy = below[x] - above[x];
            xx += gx * gx;
            xy += gx * gy;
            yy += gy * gy;
        }
    }
    constexpr float kNormalise = 1.0F / (4 * 49);  // central differences span two pixels
    const float a = kNormalise * static_cast<float>(xx), b = kNormalise * static_cast<float>(xy);
    const float c = kNormalise * static_cast<float>(yy);
    return 0.5F * (a + c - std::sqrt((a - c) * (a - c) + 4 * b * b));
}

void detectInside(
    const cv::Mat& gray, cv::Rect inside, int threshold, std::vector<cv::KeyPoint>& corners)
{
    const cv::Rect image(0, 0, gray.cols, gray.rows);
    const cv::Rect window = cv::Rect(
                                inside.x - kFastRadiusPx,
                                inside.y - kFastRadiusPx,
                                inside.width + 2 * kFastRadiusPx,
                                inside.height + 2 * kFastRadiusPx) &
                            image;
    std::vector<cv::KeyPoint> found;
    cv::FAST(gray(window), found, threshold, true);
    for (cv::KeyPoint& point : found)
    {
        point.pt.x += static_cast<float>(window.x);
        point.pt.y += static_cast<float>(window.y);
        const cv::Point pixel(point.pt);
        if (inside.contains(pixel))
        {
            point.response = cornerStrength(gray, pixel.x, pixel.y);
            corners.push_back(point);
        }
    }
}
}  // namespace

std::vector<cv::KeyPoint> fastCorners(const cv::Mat& gray, int threshold, int cellPx, int borderPx)
{
    const cv::Rect inside(borderPx, borderPx, gray.cols - 2 * borderPx, gray.rows - 2 * borderPx);
    std::vector<cv::KeyPoint> corners;
    if (inside.width <= 0 || inside.height <= 0)
    {
        return corners;
    }
    detectInside(gray, inside, threshold, corners);

    const int cols = (inside.width - 1) / cellPx + 1, rows = (inside.height - 1) / cellPx + 1;
    std::vector<char> isFilled(static_cast<size_t>(cols * rows), 0);
    for (const cv::KeyPoint& point : corners)
    {
        const int col = (static_cast<int>(point.pt.x) - inside.x) / cellPx;
        const int row = (static_cast<int>(point.pt.y) - inside.y) / cellPx;
        isFilled[static_cast<size_t>(row * cols + col)] = 1;
    }
    const int lower = std::max(kMinThreshold, threshold / 3);
    for (int cell = 0; cell < cols * rows && lower < threshold; ++cell)
    {
        if (isFilled[static_cast<size_t>(cell)] == 0)
        {
            const cv::Rect window(
                inside.x + cell % cols * cellPx, inside.y + cell / cols * cellPx, cellPx, cellPx);
            detectInside(gray, window & inside, lower, corners);
        }
    }
    return corners;
}

void refineCorners(const cv::Mat& gray, std::vector<cv::KeyPoint>& corners)
{
    if (corners.empty())
    {
        return;
    }
    std::vector<cv::Point2f> refined;
    cv::KeyPoint::convert(corners, refined);
    const cv::TermCriteria criteria(
        cv::TermCriteria::COUNT + cv::TermCriteria::EPS, /*maxCount*/ 8, /*epsilon*/ 0.03);
    cv::cornerSubPix(gray, refined, cv::Size(3, 3), cv::Size(-1, -1), criteria);
    for (size_t i = 0; i < corners.size(); ++i)
    {
        const cv::Point2f move = refined[i] - corners[i].pt;
        if (std::abs(move.x) < kMaxRefinementPx && std::abs(move.y) < kMaxRefinementPx)
        {
            corners[i].pt = refined[i];
        }
    }
}
}  // namespace pointplane
