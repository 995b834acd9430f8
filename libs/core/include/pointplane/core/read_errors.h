// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>
#include <stdexcept>
#include <string>

namespace pointplane
{
/** Where a file that is read line by line ends: for getline(), a disk that fails is an end, too.
 * \throws std::runtime_error naming the file */
inline void requireRead(const std::istream& file, const std::string& path)
{
    if (file.bad())
    {
        throw std::runtime_error("cannot read " + path + ": input/output error");
    }
}
}  // namespace pointplane
