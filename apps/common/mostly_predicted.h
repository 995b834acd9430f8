// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** So begins the last line of a pointplane-odometry that ends with kExitIncomplete for this alone.
 */
constexpr const char* kMostlyPredicted =
    "pointplane-odometry: most of the motion is predicted, not measured: ";
}  // namespace pointplane
