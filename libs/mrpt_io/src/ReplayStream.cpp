// SPDX-License-Identifier: BSD-3-Clause
#include "ReplayStream.h"

#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace pointplane
{
std::size_t ReplayStream::Read(void* buffer, std::size_t count)
{
    constexpr std::size_t kChunk = 1U << 20U;
    while (live_ != nullptr && bytes_.size() - position_ < count)
    {
        const std::size_t at = bytes_.size();
        const std::size_t step = std::min(kChunk, count - (at - position_));
        bytes_.resize(at + step);
        const std::size_t n = live_->read(bytes_.data() + at, step);
        bytes_.resize(at + n);
        if (n < step)
        {
            break;
        }
    }
    if (bytes_.size() - position_ < count)
    {
        throw std::runtime_error("the file stops inside an object");
    }
    std::memcpy(buffer, bytes_.data() + position_, count);
    position_ += count;
    return count;
}

mrpt::serialization::CSerializable::Ptr deserialise(std::vector<std::uint8_t>& bytes, GzInput* live)
{
    ReplayStream stream(bytes, 0, live);
    auto archive = mrpt::serialization::archiveFrom(static_cast<mrpt::io::CStream&>(stream));
    return archive.ReadObject();
}

void requireRoom(std::size_t size, std::vector<std::uint8_t>& room)
{
    room.reserve(size);
    room = std::vector<std::uint8_t>();
}
}  // namespace pointplane
