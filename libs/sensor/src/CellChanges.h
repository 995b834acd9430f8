// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/CellView.h>
#include <pointplane/sensor/DepthNoise.h>

#include <limits>
#include <vector>

namespace pointplane
{
enum class Change : std::uint8_t
{
    Unknown,
    Same,         //!< but it may have moved along itself
    SamePattern,  //!< and it has not
    Changed
};

struct CellChange
{
    Change change{Change::Unknown};
    float nearest{std::numeric_limits<float>::infinity()}, farthest{0};  //!< later [m]; 0: none
};

/** What has become of each cell of a view. */
class CellChanges
{
 public:
    CellChanges(const CellView& earlier, const CellView& later, const DepthNoise& noise);

    [[nodiscard]] const cv::Size& grid() const { return grid_; }
    [[nodiscard]] const CellChange& at(const cv::Point& cell) const
    {
        return cells_[static_cast<std::size_t>(cell.y * grid_.width + cell.x)];
    }
    /** Row by row. */
    [[nodiscard]] const std::vector<CellChange>& all() const { return cells_; }

 private:
    cv::Size grid_;
    std::vector<CellChange> cells_;
};
}  // namespace pointplane
