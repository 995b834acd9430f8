// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Chart.h>
#include <pointplane/evaluation/Trajectory.h>

#include <cstddef>
#include <vector>

namespace pointplane
{
/** The next point begins another line. */
void interrupt(ChartSeries& series);

/** Where no line joins poses: nothing is known of the way between them. */
class ChartHoles
{
 public:
    explicit ChartHoles(const Trajectory& trajectory);

    /** Whether there is a hole before a pose. */
    [[nodiscard]] bool isBefore(std::size_t pose) const { return holes_[pose]; }
    /** Whether there is one on the way from one pose to a later one, or that way is as long as one:
     * what is drawn is of poses that have ground truth. */
    [[nodiscard]] bool isBetween(std::size_t from, std::size_t to) const;

 private:
    const Trajectory& trajectory_;
    std::vector<bool> holes_;
    double longestStep_;
};
}  // namespace pointplane
