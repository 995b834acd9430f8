// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** Fewer points than this may agree by chance. */
constexpr int kFewPoints = 8;
}  // namespace pointplane
