// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pointplane
{
/** \throws std::runtime_error */
[[noreturn]] void failAt(const std::string& path, std::size_t line, const std::string& what);

/** The columns of a trajectory, separated by blanks or commas; empty: there is nothing in the line.
 * \param hint to what may be wrong where there is no number
 * \throws std::runtime_error that names file and line, and what the line is instead */
[[nodiscard]] std::vector<double> numbersOfLine(
    const std::string& text, const std::string& path, std::size_t line, const std::string& hint);
}  // namespace pointplane
