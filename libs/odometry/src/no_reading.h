// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace pointplane
{
/** Depth of a pixel that was not measured, or that is left out [m]. */
constexpr float kNoReading = std::numeric_limits<float>::quiet_NaN();
}  // namespace pointplane
