// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** Radians inside, degrees for people: deg = rad * kDegreesPerRadian. */
inline constexpr double kDegreesPerRadian = 180 / 3.14159265358979323846;
}  // namespace pointplane
