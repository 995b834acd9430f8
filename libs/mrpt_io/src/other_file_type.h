// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace pointplane
{
/** A kind of file that is no rawlog. */
struct OtherFileType
{
    std::string name;    //!< "a text file"
    std::string advice;  //!< how a rawlog is made of it, or empty
};

/** By its first bytes, else by its name. \return nothing if it may be a rawlog */
[[nodiscard]] std::optional<OtherFileType> otherFileType(const std::string& path);

/** As by `gzip a.rawlog`, although rawlogs are compressed. */
[[nodiscard]] bool isCompressedTwice(const std::string& path);
}  // namespace pointplane
