// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/rpe.h>

#include <string>

namespace pointplane
{
/** Length of the increments whose covariance is tested: frames or seconds. */
struct NeesInterval
{
    double delta{1};
    DeltaUnit unit{DeltaUnit::Frames};
    bool sinceStart{false};  //!< all increments from the first pose instead: the poses themselves
};

/** From "1f", "10f", "0.5s" or "start". \throws std::invalid_argument for anything else */
[[nodiscard]] NeesInterval neesIntervalFromName(const std::string& name);
[[nodiscard]] std::string nameOf(const NeesInterval& interval);

/** In words: "10 frames", "1 s". */
[[nodiscard]] std::string describe(const NeesInterval& interval);
}  // namespace pointplane
