// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** Last line of a pointplane-odometry that ends with kExitIncomplete for this alone. */
constexpr const char* kNothingMeasured =
    "pointplane-odometry: no motion was measured, all of it is predicted; are the units of depth "
    "right?";
}  // namespace pointplane
