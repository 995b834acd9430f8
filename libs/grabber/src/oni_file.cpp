// SPDX-License-Identifier: BSD-3-Clause
#include "oni_file.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <map>

#include <fcntl.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
// The format is that of OpenNI2 (Source/Drivers/OniFile/Formats/DataRecords.h): a header, then
// records with a header of 28 bytes: magic number, kind, node, bytes with header, bytes behind
// them.
constexpr std::int64_t kFileHeader = 24;
constexpr std::uint32_t kMagic = 0x0052494E;  // "NIR"
constexpr std::uint32_t kBegin = 8, kFrame = 10, kEnd = 11, kIndex = 14;
constexpr std::uint32_t kLeastSize = 28, kIndexEntry = 20;

/** The records of a file, up to the one that ends it. */
struct OniRecords
{
    std::map<std::uint32_t, std::uint32_t> frames;   //!< of each node
    std::map<std::uint32_t, std::uint32_t> indexed;  //!< likewise, by its index at the end
    int numBegun{0};                                 //!< nodes whose frames are taken
    std::int64_t end{-1};  //!< where the last record is; -1: there is none
};

[[nodiscard]] OniRecords recordsOf(const std::string& path)
{
    OniRecords out;
    std::ifstream file(path, std::ios::binary);
    std::array<std::uint32_t, 5> header{};
    std::int64_t place = kFileHeader;
    while (file.seekg(place) && file.read(reinterpret_cast<char*>(header.data()), sizeof(header)))
    {
        const auto [magic, kind, node, size, sizeBehind] = header;
        if (magic != kMagic || size < kLeastSize)
        {
            return out;
        }
        if (kind == kEnd)
        {
            out.end = place;
            return out;
        }
        out.numBegun += kind == kBegin ? 1 : 0;
        out.frames[node] += kind == kFrame ? 1 : 0;
        // Its first entry stands for no frame.
        out.indexed[node] += kind == kIndex ? sizeBehind / kIndexEntry - 1 : 0;
        place += static_cast<std::int64_t>(size) + sizeBehind;
    }
    return out;
}

/** \return the first byte that was never written, or the size of the file */
[[nodiscard]] std::int64_t placeOfHole(const std::string& path)
{
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const std::int64_t place = fd < 0 ? -1 : ::lseek(fd, 0, SEEK_HOLE);
    if (fd >= 0)
    {
        ::close(fd);
    }
    return place;
}
}  // namespace

std::string problemOfOniFile(const std::string& path)
{
    const OniRecords records = recordsOf(path);
    const bool isWhole =
        records.end >= 0 && records.frames == records.indexed && placeOfHole(path) > records.end;
    return isWhole ? ""
                   : "'" + path + "' is incomplete: it could not be written, or the disk is full";
}

bool oniFileHasBegun(const std::string& path, int numStreams)
{
    return recordsOf(path).numBegun == numStreams;
}
}  // namespace pointplane
