// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace pointplane
{
/** Of options that name a camera: one line that can be printed. Others would break the lines of
 * summaries and of status comments. */
[[nodiscard]] CLI::Validator isLabel();
}  // namespace pointplane
