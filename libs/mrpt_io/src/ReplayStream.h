// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/io/CStream.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstdint>
#include <vector>

#include "GzInput.h"

namespace pointplane
{
/** MRPT's view of bytes in memory, optionally continued by a file; what comes from the file is
 * appended to the bytes. A short read throws: MRPT would take the rest of a buffer as it was. */
class ReplayStream : public mrpt::io::CStream
{
 public:
    /** \param live continued from here after the bytes; may be nullptr */
    ReplayStream(std::vector<std::uint8_t>& bytes, std::size_t position, GzInput* live)
        : bytes_(bytes), position_(position), live_(live)
    {
    }

    std::size_t Read(void* buffer, std::size_t count) override;
    std::size_t Write(const void*, std::size_t) override { return 0; }
    std::uint64_t Seek(std::int64_t, TSeekOrigin) override { return position_; }
    [[nodiscard]] std::uint64_t getTotalBytesCount() const override { return bytes_.size(); }
    [[nodiscard]] std::uint64_t getPosition() const override { return position_; }

 private:
    std::vector<std::uint8_t>& bytes_;
    std::size_t position_;
    GzInput* live_;
};

/** The object that MRPT reads from these bytes. \param live what they go on with, or nullptr */
[[nodiscard]] mrpt::serialization::CSerializable::Ptr deserialise(
    std::vector<std::uint8_t>& bytes, GzInput* live);

/** MRPT (2.5.8) writes a range image to memory that it did not get. So memory for the object is
 * asked for and given back before; another thread may still be quicker. \param room of the caller,
 * or a compiler may leave it out */
void requireRoom(std::size_t size, std::vector<std::uint8_t>& room);
}  // namespace pointplane
