// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <sys/types.h>

namespace pointplane
{
/** Which file or folder a name leads to. Two names are of the same one if they lead to the same
 * inode, through symbolic or hard links, or will when they are written. */
struct FileIdentity
{
    explicit FileIdentity(const std::string& name);

    [[nodiscard]] bool isSame(const FileIdentity& other) const;
    [[nodiscard]] bool isIn(const FileIdentity& folder) const;

    std::string path;  //!< absolute, without links
    dev_t device{0};
    ino_t inode{0};  //!< 0: is not there
};
}  // namespace pointplane
