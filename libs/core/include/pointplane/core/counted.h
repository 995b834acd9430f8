// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace pointplane
{
/** "1 frame", "2 frames". */
[[nodiscard]] inline std::string counted(std::size_t number, const std::string& thing)
{
    return std::to_string(number) + " " + thing + (number == 1 ? "" : "s");
}

[[nodiscard]] inline std::string framesText(std::size_t number) { return counted(number, "frame"); }
}  // namespace pointplane
