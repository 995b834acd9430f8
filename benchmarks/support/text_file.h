// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** \throws EnvironmentError when it cannot be written */
void writeTextFile(const std::string& path, const std::string& text);
}  // namespace pointplane
