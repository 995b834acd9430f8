// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/quantile.h>
#include <pointplane/core/significance.h>
#include <pointplane/sensor/AttachedParts.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include "CellChanges.h"

namespace pointplane
{
namespace
{
/** Once, a cell may look the same by chance. */
constexpr int kTimes = 2;

/** The smallest part takes so much of the view. */
constexpr double kSmallestPart = 0.01;

/** Depths of neighbours on one surface differ by less than this fraction. */
constexpr float kStep = 0.1F;

using Mask = cv::Mat_<std::uint8_t>;

bool isFlat(const CellChange& cell) { return cell.farthest < (1 + kStep) * cell.nearest; }

/** Surface of a cell, in proportion. */
double area(const CellChange& cell)
{
    const auto z = static_cast<double>(cell.farthest);
    return z * z;
}

/** Whether most of the surface has changed, and most of the view. A far screen with a film is a
 * large surface; a near person fills the view. */
bool isElsewhere(const CellChanges& cells)
{
    double changed = 0, rest = 0;
    int numChanged = 0, numOthers = 0;
    for (const CellChange& cell : cells.all())
    {
        const bool hasChanged = cell.change == Change::Changed;
        (hasChanged ? changed : rest) += area(cell);
        (hasChanged ? numChanged : numOthers) += cell.farthest > 0 ? 1 : 0;
    }
    return changed > kClearlyLarger * rest && numChanged > numOthers;
}

/** Of the cells that have changed. */
float medianDepth(const CellChanges& cells)
{
    std::vector<float> depths;
    for (const CellChange& cell : cells.all())
    {
        if (cell.change == Change::Changed)
        {
            depths.push_back(cell.nearest);
        }
    }
    return median(std::move(depths));
}

/** How many times in a row each cell was nearer than what moves and stayed the same. */
void count(const CellChanges& cells, float farthest, Mask& timesSame)
{
    for (cv::Point at; at.y < cells.grid().height; ++at.y)
    {
        for (at.x = 0; at.x < cells.grid().width; ++at.x)
        {
            const CellChange& cell = cells.at(at);
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
void grow(const CellChanges& cells, float farthest, Mask& parts)
{
    const cv::Rect all({}, cells.grid());
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
            const CellChange &from = cells.at(at), &cell = cells.at(to);
            const bool isSame = cell.change != Change::Changed && cell.farthest < farthest;
            const float ratio = cell.nearest / from.nearest;
            if (isSame && isFlat(cell) && ratio < 1 + kStep && ratio > 1 - kStep)
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
    CellView later(frame);
    if (cv::countNonZero(later.depth > 0) == 0)
    {
        return;  // nothing could be compared with it
    }
    if (earlier_.gray.size() != later.gray.size())
    {
        later.findContrast();
        earlier_ = later;
        timesSame_ = Mask(later.contrast.size(), std::uint8_t(0));
        mask_.release();
        return;
    }
    if (!isElsewhere(CellChanges(earlier_, later, noise)))
    {
        return;
    }
    later.findContrast();
    const CellChanges cells(earlier_, later, noise);
    if (!isElsewhere(cells))
    {
        return;  // the image shows nothing, as in the dark
    }
    const float farthest = medianDepth(cells);
    count(cells, farthest, timesSame_);
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
