// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** By so many standard deviations, a single measured value has changed: chance does it to three in
 * a thousand. */
constexpr double kUnlikelySigmas = 3;

/** By so many, it is no chance, of however many values: it does it to one in a million. */
constexpr double kNoChanceSigmas = 5;
}  // namespace pointplane
