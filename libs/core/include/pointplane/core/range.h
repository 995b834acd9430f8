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

/** The same of a length [m]. Its range is such that millimetres are noticed, and told. */
inline void checkLength(const char* key, double value, double low, double high)
{
    constexpr double kMillimetresPerMetre = 1000;
    const double metres = value / kMillimetresPerMetre;
    POINTPLANE_CHECK(
        metres < low || metres > high || (value >= low && value <= high),
        key << " = " << value << " is not in [" << low << ", " << high << "]: it is in metres, and "
            << value << " mm are " << metres);
    checkRange(key, value, low, high);
}
}  // namespace pointplane
