// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** What kind of file it is by its first bytes: "a text file"; empty if it may be a rawlog. */
[[nodiscard]] std::string otherFileType(const std::string& path);

/** As by `gzip a.rawlog`, although rawlogs are compressed. */
[[nodiscard]] bool isCompressedTwice(const std::string& path);
}  // namespace pointplane
