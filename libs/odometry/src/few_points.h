// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** Fewer points than this may agree by chance. */
constexpr int kFewPoints = 8;

/** So many points that agree on another motion than the others are no wrong matches. */
constexpr int kPointsOfAMotion = 20;
}  // namespace pointplane
