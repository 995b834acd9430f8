// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** A single value that is off by more standard deviations has changed: chance alone moves three of
 * a thousand values as far. */
constexpr double kUnlikelySigmas = 3;

/** Even of many values, one that is off by more has changed: chance alone moves one of two million
 * as far. */
constexpr double kNoChanceSigmas = 5;

/** Of two surfaces, one that is so many times as large is clearly the larger. */
constexpr double kClearlyLarger = 1.5;
}  // namespace pointplane
