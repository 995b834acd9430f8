// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pointplane
{
/** Of options that are one of a few words. CLI11's own show how they work inside. */
[[nodiscard]] CLI::Validator isOneOf(const std::vector<std::string>& words);
}  // namespace pointplane
