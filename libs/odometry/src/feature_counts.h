// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace pointplane
{
/** Fewer points than this may agree by chance. */
constexpr int kFewPoints = 8;

/** Points and planes counted together: three points fix a plane, so a plane counts as three. */
inline size_t numAsPoints(size_t points, size_t planes) { return points + 3 * planes; }
}  // namespace pointplane
