// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace pointplane
{
/** Class of chartStyle() for a colour. \param name of the colour, or empty \param index in the
 * palette */
[[nodiscard]] std::string colourClass(const std::string& name, std::size_t index);

/** Blue, yellow, red: visible on white and on black. \param level in [0, 1] */
[[nodiscard]] std::string levelColour(double level);
}  // namespace pointplane
