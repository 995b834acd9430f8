// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <istream>
#include <limits>
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

/** All bytes of a file, or the first `most`. Where a disk fails, they end, and file.bad() tells it:
 * an std::istreambuf_iterator would throw, and not name the file. */
template <class Bytes = std::string>
[[nodiscard]] Bytes readAll(
    std::istream& file, std::size_t most = std::numeric_limits<std::size_t>::max())
{
    Bytes out;
    std::array<char, 1U << 16U> part;
    while (file && out.size() < most)
    {
        const std::size_t left = std::min(part.size(), most - out.size());
        file.read(part.data(), static_cast<std::streamsize>(left));
        out.insert(out.end(), part.data(), part.data() + file.gcount());
    }
    return out;
}
}  // namespace pointplane
