// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/AttachedParts.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pointplane
{
namespace
{
constexpr int kColumns = 40;   // of the grid of cells
constexpr int kGraySide = 8;   // [px] of a cell
constexpr int kDepthSide = 2;  // [px] likewise

/** Correlation of a pattern with itself later, and with one that took its place. */
constexpr double kSame = 0.9, kOther = 0.5;

/** A pattern shows a shift by so many pixels if its correlation with itself is smaller there. */
constexpr int kShift = 2;
constexpr double kShifted = 0.8;

/** Most of the surface: so many times as much changes as does not. */
constexpr double kMost = 1.5;

/** Once, a cell may look the same by chance. */
constexpr int kTimes = 2;

/** The smallest part takes so much of the view. */
constexpr double kSmallestPart = 0.01;

/** Depths of neighbours on one surface differ by less than this fraction. */
constexpr float kStep = 0.1F;

enum class Contrast : std::uint8_t
{
    Noise,
    Pattern,    //!< but it may look the same along a line
    ShowsShift  //!< in all directions
};

enum class Change : std::uint8_t
{
    Unknown,
    Same,         //!< but it may have moved along itself
    SamePattern,  //!< and it has not
    Changed
};

struct Cell
{
    Change change{Change::Unknown};
    float nearest{std::numeric_limits<float>::infinity()}, farthest{0};  //!< later [m]; 0: none

    [[nodiscard]] bool isFlat() const { return farthest < (1 + kStep) * nearest; }
};
/** Of the grid, row by row. */
struct Cells
{
    explicit Cells(const cv::Size& size) : grid(size), cells(static_cast<size_t>(size.area())) {}
    [[nodiscard]] size_t index(const cv::Point& p) const
    {
        return static_cast<size_t>(p.y * grid.width + p.x);
    }
    [[nodiscard]] Cell& at(const cv::Point& p) { return cells[index(p)]; }
    [[nodiscard]] const Cell& at(const cv::Point& p) const { return cells[index(p)]; }

    cv::Size grid;
    std::vector<Cell> cells;
};
using Mask = cv::Mat_<std::uint8_t>;

Mask square(const Mask& image, const cv::Point& cell)
{
    return image({cell.x * kGraySide, cell.y * kGraySide, kGraySide, kGraySide});
}

/** Zero-mean normalised cross-correlation; 0 if one of them has no contrast. */
double correlation(const Mask& a, const Mask& b)
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
std::pair<double, double> selfCorrelation(const Mask& around, const cv::Point& cell, int shift)
{
    const cv::Rect place(
        cell.x * kGraySide + kShift, cell.y * kGraySide + kShift, kGraySide, kGraySide);
    const Mask pattern = around(place);
    std::pair<double, double> out(1, -1);
    for (const cv::Point& direction : {cv::Point(1, 0), {0, 1}, {1, 1}, {1, -1}})
    {
        for (const int length : {-shift, shift})
        {
            const double c = correlation(pattern, around(place + length * direction));
            out = {std::min(out.first, c), std::max(out.second, c)};
        }
    }
    return out;
}

/** Noise does not look like itself a pixel away, unlike a pattern. */
Contrast contrastOf(const Mask& around, const cv::Point& cell)
{
    return selfCorrelation(around, cell, 1).first < kOther           ? Contrast::Noise
           : selfCorrelation(around, cell, kShift).second > kShifted ? Contrast::Pattern
                                                                     : Contrast::ShowsShift;
}

AttachedParts::View viewOf(const RgbdFrame& frame)
{
    const cv::Size size = frame.depth.size();
    const cv::Size grid(kColumns, std::max(1, kColumns * size.height / size.width));
    AttachedParts::View out;
    cv::resize(frame.gray, out.gray, grid * kGraySide, 0, 0, cv::INTER_AREA);
    cv::resize(frame.depth, out.depth, grid * kDepthSide, 0, 0, cv::INTER_NEAREST);
    out.contrast.create(grid);
    return out;
}

void findContrast(AttachedParts::View& view)
{
    Mask around;
    cv::copyMakeBorder(view.gray, around, kShift, kShift, kShift, kShift, cv::BORDER_REFLECT_101);
    for (cv::Point cell; cell.y < view.contrast.rows; ++cell.y)
    {
        for (cell.x = 0; cell.x < view.contrast.cols; ++cell.x)
        {
            view.contrast(cell) = static_cast<std::uint8_t>(contrastOf(around, cell));
        }
    }
}

/** By depth alone. */
Cell compareDepth(
    const AttachedParts::View& earlier,
    const AttachedParts::View& later,
    const cv::Point& cell,
    const DepthNoise& noise)
{
    Cell out;
    int numCompared = 0, numOther = 0;
    for (int v = cell.y * kDepthSide; v < (cell.y + 1) * kDepthSide; ++v)
    {
        for (int u = cell.x * kDepthSide; u < (cell.x + 1) * kDepthSide; ++u)
        {
            const float before = earlier.depth(v, u), now = later.depth(v, u);
            if (before > 0 && now > 0)
            {
                out.nearest = std::min(out.nearest, now);
                out.farthest = std::max(out.farthest, now);
                const auto most = static_cast<float>(noise.sameDepth(static_cast<double>(now)));
                numOther += std::abs(before - now) > most ? 1 : 0;
                ++numCompared;
            }
        }
    }
    if (numCompared > 0)
    {
        out.change = 2 * numOther > numCompared ? Change::Changed : Change::Same;
    }
    return out;
}

Cell compareCell(
    const AttachedParts::View& earlier,
    const AttachedParts::View& later,
    const cv::Point& cell,
    const DepthNoise& noise)
{
    Cell out = compareDepth(earlier, later, cell, noise);
    const auto contrast = static_cast<Contrast>(earlier.contrast(cell));
    if (out.change == Change::Same && contrast != Contrast::Noise)
    {
        const double c = correlation(square(earlier.gray, cell), square(later.gray, cell));
        out.change = c < kOther                                      ? Change::Changed
                     : c > kSame && contrast == Contrast::ShowsShift ? Change::SamePattern
                                                                     : Change::Same;
    }
    return out;
}

Cells compare(
    const AttachedParts::View& earlier, const AttachedParts::View& later, const DepthNoise& noise)
{
    Cells out(later.contrast.size());
    for (cv::Point at; at.y < out.grid.height; ++at.y)
    {
        for (at.x = 0; at.x < out.grid.width; ++at.x)
        {
            out.at(at) = compareCell(earlier, later, at, noise);
        }
    }
    return out;
}

/** Surface of a cell, in proportion. */
double area(const Cell& cell)
{
    const auto z = static_cast<double>(cell.farthest);
    return z * z;
}

/** Whether most of the surface has changed. */
bool isElsewhere(const Cells& cells)
{
    double changed = 0, rest = 0;
    for (const Cell& cell : cells.cells)
    {
        (cell.change == Change::Changed ? changed : rest) += area(cell);
    }
    return changed > kMost * rest;
}

/** Of the cells that have changed. */
float medianDepth(const Cells& cells)
{
    std::vector<float> depths;
    for (const Cell& cell : cells.cells)
    {
        if (cell.change == Change::Changed)
        {
            depths.push_back(cell.nearest);
        }
    }
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    return *middle;
}

/** How many times in a row each cell was nearer than what moves and stayed the same. */
void count(const Cells& cells, float farthest, Mask& timesSame)
{
    for (cv::Point at; at.y < cells.grid.height; ++at.y)
    {
        for (at.x = 0; at.x < cells.grid.width; ++at.x)
        {
            const Cell& cell = cells.at(at);
            std::uint8_t& times = timesSame(at);
            if (cell.change == Change::Changed)
            {
                times = 0;
            }
            else if (cell.change == Change::SamePattern && cell.farthest < farthest)
            {
                times = static_cast<std::uint8_t>(std::min(times + 1, kTimes));
            }
        }
    }
}

/** Leaves out cells that are too few to be a part. */
void removeSpecks(Mask& parts)
{
    cv::morphologyEx(parts, parts, cv::MORPH_CLOSE, cv::Mat(), {-1, -1}, 2);
    cv::Mat labels, stats, centroids;
    const int num = cv::connectedComponentsWithStats(parts, labels, stats, centroids);
    for (int i = 1; i < num; ++i)
    {
        if (stats.at<int>(i, cv::CC_STAT_AREA) < kSmallestPart * static_cast<double>(parts.total()))
        {
            parts.setTo(0, labels == i);
        }
    }
}

/** A part without a pattern, too, as far as its surface goes on and stays the same. */
void grow(const Cells& cells, float farthest, Mask& parts)
{
    const cv::Rect all({}, cells.grid);
    std::vector<cv::Point> next;
    cv::findNonZero(parts, next);
    while (!next.empty())
    {
        const cv::Point at = next.back();
        next.pop_back();
        for (const cv::Point& step : {cv::Point(1, 0), {-1, 0}, {0, 1}, {0, -1}})
        {
            const cv::Point to = at + step;
            if (!all.contains(to) || parts(to) != 0)
            {
                continue;
            }
            const Cell &from = cells.at(at), &cell = cells.at(to);
            const bool isSame = cell.change != Change::Changed && cell.farthest < farthest;
            const float ratio = cell.nearest / from.nearest;
            if (isSame && cell.isFlat() && ratio < 1 + kStep && ratio > 1 - kStep)
            {
                parts(to) = 255;
                next.push_back(to);
            }
        }
    }
}
}  // namespace

void AttachedParts::update(const RgbdFrame& frame, const DepthNoise& noise)
{
    if (frame.gray.empty() || frame.depth.empty())
    {
        return;
    }
    View later = viewOf(frame);
    if (cv::countNonZero(later.depth > 0) == 0)
    {
        return;  // nothing could be compared with it
    }
    const cv::Size grid = later.contrast.size();
    if (earlier_.gray.size() != later.gray.size())
    {
        findContrast(later);
        earlier_ = later;
        timesSame_ = Mask(grid, std::uint8_t(0));
        mask_.release();
        return;
    }
    const Cells cells = compare(earlier_, later, noise);
    if (!isElsewhere(cells))
    {
        return;
    }
    const float farthest = medianDepth(cells);
    count(cells, farthest, timesSame_);
    findContrast(later);
    earlier_ = later;
    Mask parts(cv::Mat(timesSame_ >= kTimes));
    removeSpecks(parts);
    grow(cells, farthest, parts);
    cv::dilate(parts, parts, cv::Mat());
    mask_.release();
    if (cv::countNonZero(parts) > 0)
    {
        cv::resize(parts, mask_, frame.depth.size(), 0, 0, cv::INTER_NEAREST);
    }
}

double AttachedParts::share() const
{
    return mask_.empty()
               ? 0
               : static_cast<double>(cv::countNonZero(mask_)) / static_cast<double>(mask_.total());
}
}  // namespace pointplane
