// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/CellView.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pointplane
{
namespace
{
constexpr int kColumns = 40;  // of the grid
constexpr int kGraySide = 8;  // [px] of a cell

/** A pattern shows a shift by so many pixels if its correlation with itself is smaller there. */
constexpr int kShift = 2;
constexpr double kShifted = 0.8;

using GrayImage = cv::Mat_<std::uint8_t>;

/** CellView::correlation() */
double correlationOf(const GrayImage& a, const GrayImage& b)
{
    int sumA = 0, sumB = 0, sumAA = 0, sumBB = 0, sumAB = 0;
    for (int v = 0; v < kGraySide; ++v)
    {
        const auto *rowA = a[v], *rowB = b[v];
        for (int u = 0; u < kGraySide; ++u)
        {
            const int x = rowA[u], y = rowB[u];
            sumA += x;
            sumB += y;
            sumAA += x * x;
            sumBB += y * y;
            sumAB += x * y;
        }
    }
    constexpr double kPixels = kGraySide * kGraySide;
    const double varA = sumAA - sumA * (sumA / kPixels), varB = sumBB - sumB * (sumB / kPixels);
    return varA > 0 && varB > 0 ? (sumAB - sumA * (sumB / kPixels)) / std::sqrt(varA * varB) : 0;
}

/** Least and largest correlation of a cell's pattern with itself, shifted in all directions.
 * \param around the image with a border of kShift */
std::pair<double, double> selfCorrelation(const GrayImage& around, const cv::Point& cell, int shift)
{
    const cv::Rect place(
        cell.x * kGraySide + kShift, cell.y * kGraySide + kShift, kGraySide, kGraySide);
    const GrayImage pattern = around(place);
    std::pair<double, double> out(1, -1);
    for (const cv::Point& direction : {cv::Point(1, 0), {0, 1}, {1, 1}, {1, -1}})
    {
        for (const int length : {-shift, shift})
        {
            const double c = correlationOf(pattern, around(place + length * direction));
            out = {std::min(out.first, c), std::max(out.second, c)};
        }
    }
    return out;
}

/** Noise does not look like itself a pixel away, unlike a pattern. */
CellView::Contrast contrastOf(const GrayImage& around, const cv::Point& cell)
{
    return selfCorrelation(around, cell, 1).first < kOtherPattern ? CellView::Contrast::Noise
           : selfCorrelation(around, cell, kShift).second > kShifted
               ? CellView::Contrast::Pattern
               : CellView::Contrast::ShowsShift;
}
}  // namespace

CellView::CellView(const RgbdFrame& frame)
{
    const cv::Size size = frame.depth.size();
    const cv::Size grid(kColumns, std::max(1, kColumns * size.height / size.width));
    cv::resize(frame.gray, gray, grid * kGraySide, 0, 0, cv::INTER_AREA);
    cv::resize(frame.depth, depth, grid * kDepthSide, 0, 0, cv::INTER_NEAREST);
    contrast = cv::Mat_<std::uint8_t>(grid, static_cast<std::uint8_t>(Contrast::Pattern));
}

void CellView::findContrast()
{
    GrayImage around;
    cv::copyMakeBorder(gray, around, kShift, kShift, kShift, kShift, cv::BORDER_REFLECT_101);
    for (cv::Point cell; cell.y < contrast.rows; ++cell.y)
    {
        for (cell.x = 0; cell.x < contrast.cols; ++cell.x)
        {
            contrast(cell) = static_cast<std::uint8_t>(contrastOf(around, cell));
        }
    }
}

double CellView::correlation(const CellView& other, const cv::Point& cell) const
{
    const cv::Rect square(cell.x * kGraySide, cell.y * kGraySide, kGraySide, kGraySide);
    return correlationOf(gray(square), other.gray(square));
}
}  // namespace pointplane
