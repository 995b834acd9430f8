// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/obs_frwds.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace pointplane
{
enum class RawlogEnd
{
    Open,         //!< not reached yet
    Clean,        //!< after the last object, checksum right
    Truncated,    //!< the file stops too early
    Damaged,      //!< the bytes are not what was written
    NotSupported  //!< an object of a class or version that MRPT's library for observations lacks
};

/** Which objects a reader takes. */
enum class RawlogClasses
{
    /** Also those that only MRPT can read. It believes the lengths in them: a damaged one, in a
     * file without a checksum, may take gigabytes of memory. */
    All,
    Known  //!< only those whose layout is known here: for files of strangers
};

/** How and where reading ended. */
struct RawlogEnding
{
    RawlogEnd kind{RawlogEnd::Open};
    std::size_t objectIndex{0};   //!< of the object that could not be read, from 0
    std::uint64_t byteOffset{0};  //!< in the file (compressed bytes if it is compressed)
    std::string message;          //!< one line that names the file; empty when clean
};

/** An object as it is in the file, for RawlogWriter::write(). */
struct RawlogRecord
{
    std::vector<std::uint8_t> bytes;  //!< as MRPT serialised it
    /** Instead of them, where the object is a gz member by itself: its compressed data, checksum
     * and length. */
    std::vector<std::uint8_t> member;
};

/** Streams the objects of a rawlog, one at a time: observations (format 2), or CActionCollection
 * and CSensoryFrame in turns (format 1); plain or gz.
 *
 * MRPT's own reader takes damage for the end of the file, or crashes. This one
 *
 * - verifies the checksum and length of gz data;
 * - checks sizes inside an object (images, range images, strings) against the bytes of the file
 *   before MRPT sees them, for the current versions of the classes of RGB-D, wheels, IMU, 2D laser
 *   and single cameras;
 * - leaves objects of other classes and versions to MRPT, unless a checksum of the file is wrong:
 *   then the object counts as damaged. A plain file, a pipe and a truncated file have no checksum.
 *
 * A plain file that stops exactly between two objects cannot be told from a complete one. Not
 * thread-safe. */
class RawlogReader
{
 public:
    /** \throws InputError if the file is missing, empty, unreadable or not a rawlog */
    explicit RawlogReader(const std::string& path, RawlogClasses classes = RawlogClasses::All);
    ~RawlogReader();
    RawlogReader(const RawlogReader&) = delete;
    RawlogReader& operator=(const RawlogReader&) = delete;

    /** The next object, or nullptr when there is none; ending() then says why. Never throws for
     * what is in the file, but std::bad_alloc where memory is short. External images are not
     * loaded.
     */
    [[nodiscard]] mrpt::serialization::CSerializable::Ptr next();

    /** The bytes of the object that next() returned last. Can be taken once. */
    [[nodiscard]] RawlogRecord takeRecord();

    [[nodiscard]] const RawlogEnding& ending() const;
    [[nodiscard]] std::size_t numObjects() const;  //!< delivered so far
    [[nodiscard]] double progress() const;         //!< fraction of the file consumed, 0 to 1
    [[nodiscard]] const std::string& path() const;

    /** imagesFolderToRead() */
    [[nodiscard]] const std::string& externalsDirectory() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace pointplane
