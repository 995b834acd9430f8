// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace pointplane
{
/** "1 frame", "2 frames". */
[[nodiscard]] inline std::string framesText(std::size_t number)
{
    return std::to_string(number) + (number == 1 ? " frame" : " frames");
}
}  // namespace pointplane
