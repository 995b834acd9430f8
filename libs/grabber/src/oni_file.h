// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** What is wrong with an .oni file that was just recorded, or empty. OpenNI2 goes on where it
 * cannot write, and does not tell: then frames are missing, the file ends early, or has a hole. */
[[nodiscard]] std::string problemOfOniFile(const std::string& path);

/** Whether OpenNI2's recorder now takes the frames of so many streams. */
[[nodiscard]] bool oniFileHasBegun(const std::string& path, int numStreams);
}  // namespace pointplane
