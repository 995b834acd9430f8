// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** Fewer points than this may agree by chance. */
constexpr int kFewPoints = 8;

/** So many points that agree on another motion than the others are no wrong matches. */
constexpr int kPointsOfAMotion = 20;

/** Of wrong points, chance lets hardly one in twenty agree. A larger share than this is no chance,
 * even of few points. */
constexpr double kNoChanceShare = 1.0 / 3;

/** Residuals up to twice as large as usual, squared: a wrong motion disagrees more. */
constexpr double kConvincingRise = 4;
}  // namespace pointplane
