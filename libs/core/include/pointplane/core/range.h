// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/check.h>

namespace pointplane
{
/** Throws std::invalid_argument that names the key unless its value lies in [low, high].
 * Every numeric key has such a range: the values that make sense. */
inline void checkRange(const char* key, double value, double low, double high)
{
    POINTPLANE_CHECK(
        value >= low && value <= high,
        key << " = " << value << " is not in [" << low << ", " << high << "]");
}
}  // namespace pointplane
