// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** A smooth error of depth, as of bent images, is one error over a patch of this size: it scales
 * the depths of each patch by a factor of its own. */
constexpr int kPatchesPerSide = 4;
constexpr int kNumPatches = kPatchesPerSide * kPatchesPerSide;
}  // namespace pointplane
