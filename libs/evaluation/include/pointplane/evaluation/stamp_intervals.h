// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>

#include <vector>

namespace pointplane
{
/** Five median intervals [s]: what is longer is a hole. */
[[nodiscard]] double longestStep(const std::vector<double>& stamps);

/** For each pose, whether the recording has a hole before it: a lost frame, or an interval longer
 * than longestStep(). Nothing is known of the way there. The first pose has none. */
[[nodiscard]] std::vector<bool> holesBefore(const Trajectory& trajectory);

/** Median of the intervals between stamps [s]; 0 for fewer than two. */
[[nodiscard]] double medianInterval(const std::vector<double>& stamps);
}  // namespace pointplane
