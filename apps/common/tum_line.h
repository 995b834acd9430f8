// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/core/Clock.h>

#include <Eigen/Geometry>

#include <string>

namespace pointplane
{
/** A pose as the TUM benchmark writes it, `stamp tx ty tz qx qy qz qw`, without end of line. */
[[nodiscard]] std::string tumLine(mrpt::Clock::time_point stamp, const Eigen::Isometry3d& pose);
}  // namespace pointplane
