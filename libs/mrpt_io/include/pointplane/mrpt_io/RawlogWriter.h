// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace mrpt::serialization
{
class CSerializable;
}

namespace pointplane
{
struct RawlogRecord;

struct RawlogWriterOptions
{
    int compressionLevel{1};  //!< 0 to 9; 0 keeps the gz frame and its checksum
    /** After so many objects or bytes, whichever comes first, everything so far is compressed and
     * handed to the operating system. A killed process loses only what came after. Time does not
     * count, because the bytes of a file must not depend on the clock. */
    std::size_t flushEveryObjects{30};
    std::size_t flushEveryBytes{1U << 20U};
};

/** Writes a rawlog that is either complete or marked as not (OutputFile).
 *
 * Objects go to `<path>.partial`, which close() renames to `path`. Without close() the partial file
 * stays, readable up to the last flush. Every write is checked (MRPT's own stream swallows a full
 * disk). The file is gz-compressed, as MRPT's are. A large object is a gz member by itself, so that
 * a later program can copy it as it is. Not thread-safe. */
class RawlogWriter
{
 public:
    using Options = RawlogWriterOptions;

    /** Replaces a partial file that an earlier run left; `path` itself stays untouched until
     * close(). \throws EnvironmentError if the file cannot be created */
    explicit RawlogWriter(const std::string& path, const Options& options = {});
    /** Leaves the partial file if close() was not called. */
    ~RawlogWriter();
    RawlogWriter(const RawlogWriter&) = delete;
    RawlogWriter& operator=(const RawlogWriter&) = delete;

    /** Appends an observation, a CSensoryFrame or a CActionCollection.
     * \throws EnvironmentError if the disk is full or the like */
    void write(const mrpt::serialization::CSerializable& object);

    /** Appends an object as it was in another file (RawlogReader::takeRecord()), without
     * serialising it or compressing it again. \throws EnvironmentError */
    void write(const RawlogRecord& record);

    /** Hands everything written so far to the operating system. \throws EnvironmentError */
    void flush();

    /** Completes the file and renames it to path(). \throws EnvironmentError */
    void close();
    /** Removes the partial file, after a run that failed. */
    void discard() noexcept;

    [[nodiscard]] const std::string& path() const;
    [[nodiscard]] std::string partialPath() const;  //!< the path itself if that is a device
    [[nodiscard]] std::size_t numObjects() const;
    [[nodiscard]] std::uint64_t numBytes() const;  //!< before compression

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace pointplane
