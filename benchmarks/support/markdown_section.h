// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** Replaces what stands between `<!-- NAME:begin -->` and `<!-- NAME:end -->` in a file.
 * \throws InputError when the file or a marker is missing
 * \throws EnvironmentError when it cannot be written */
void replaceMarkdownSection(
    const std::string& path, const std::string& name, const std::string& text);

/** Before a long run: whether the page has the section.
 * \throws InputError like replaceMarkdownSection() */
void checkMarkdownSection(const std::string& path, const std::string& name);
}  // namespace pointplane
