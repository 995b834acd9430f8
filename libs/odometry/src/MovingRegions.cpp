// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/MovingRegions.h>

#include <algorithm>

#include "surface_comparison.h"

namespace pointplane
{
namespace
{
/** Of the eight cells around a moving one, so many move too: fewer are the noise of edges. */
constexpr int kMovingNeighbours = 2;

/** What earlier frames say of the surface in a cell. */
enum Cell : std::uint8_t
{
    Untold,
    Still,
    Moving
};

Cell cellAt(const Eigen::Vector3f& point, const std::vector<ComparedDepth>& earlier)
{
    Cell out = Untold;
    for (const ComparedDepth& depth : earlier)
    {
        const ComparedDepth::Sight sight = depth(point);
        if (sight == ComparedDepth::Sight::Vanished)
        {
            return Moving;
        }
        if (sight == ComparedDepth::Sight::Agrees)
        {
            out = Still;
        }
    }
    return out;
}

bool hasMovingNeighbours(const cv::Mat_<std::uint8_t>& cells, int column, int row)
{
    int moving = -1;  // without itself
    for (int v = std::max(0, row - 1); v <= std::min(cells.rows - 1, row + 1); ++v)
    {
        for (int u = std::max(0, column - 1); u <= std::min(cells.cols - 1, column + 1); ++u)
        {
            moving += cells(v, u) == Moving;
        }
    }
    return moving >= kMovingNeighbours;
}
}  // namespace

MovingRegions findMovingRegions(
    const RgbdFrame& current, const std::vector<EarlierView>& earlier, const DepthNoise& noise)
{
    std::vector<ComparedDepth> depths;
    depths.reserve(earlier.size());
    for (const EarlierView& view : earlier)
    {
        depths.emplace_back(*view.frame, view.T_earlier_cur, noise, view.slack_m, view.slackShare);
    }
    const PixelGrid grid = PixelGrid::coarse(current.depth.size());
    cv::Mat_<std::uint8_t> cells(grid.size, static_cast<std::uint8_t>(Untold));
    MovingRegions out;
    for (int row = 0; row < grid.size.height; ++row)
    {
        for (int column = 0; column < grid.size.width; ++column)
        {
            const Eigen::Vector3f point = surfaceAt(current, grid.pixel(column, row), noise);
            cells(row, column) = point.z() > 0 ? cellAt(point, depths) : Untold;
            out.numCompared += cells(row, column) != Untold;
        }
    }
    const cv::Rect image({}, current.depth.size());
    for (int row = 0; row < grid.size.height; ++row)
    {
        for (int column = 0; column < grid.size.width; ++column)
        {
            if (cells(row, column) == Moving && hasMovingNeighbours(cells, column, row))
            {
                const cv::Point corner =
                    grid.pixel(column, row) - cv::Point(1, 1) * (grid.step / 2);
                out.cells.push_back(cv::Rect(corner, cv::Size(grid.step, grid.step)) & image);
            }
        }
    }
    return out;
}
}  // namespace pointplane
