// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Chart.h>

#include <cstddef>
#include <vector>

namespace pointplane
{
/** The next point begins another line. */
void interrupt(ChartSeries& series);

/** Whether there is a hole on the way from one pose to a later one. \param holes holesBefore() */
[[nodiscard]] bool isHoleBetween(const std::vector<bool>& holes, std::size_t from, std::size_t to);
}  // namespace pointplane
