// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** How ground truth begins that the programs wrote, which can be made again: that of
 * pointplane-simulate, that of pointplane-convert.
 * @{ */
constexpr const char* kRenderedTruth = "# exact pose in the world of the ";
constexpr const char* kCopiedTruth = "# copied by pointplane-convert\n";
/** @} */

/** Whether nothing is lost if `text` replaces this file, or what it leads to: it is in the text, or
 * the programs' own. */
[[nodiscard]] bool isReplaceable(const std::string& path, const std::string& text);
}  // namespace pointplane
