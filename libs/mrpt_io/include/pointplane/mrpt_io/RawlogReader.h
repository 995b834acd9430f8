// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/obs_frwds.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace pointplane
{
enum class RawlogEnd
{
    Open,       //!< not reached yet
    Clean,      //!< after the last object, checksum right
    Truncated,  //!< the file stops too early
    Damaged     //!< the bytes are not what was written
};

/** Which objects a reader takes. */
enum class RawlogClasses
{
    /** Also those that MRPT alone can read. It believes the lengths in them, so that a damaged one
     * may take gigabytes of memory. */
    All,
    Known  //!< only those whose layout is known here; another one is damage: for files of strangers
};

/** How and where reading ended. */
struct RawlogEnding
{
    RawlogEnd kind{RawlogEnd::Open};
    std::size_t objectIndex{0};   //!< of the object that could not be read, from 0
    std::uint64_t byteOffset{0};  //!< in the file (compressed bytes if it is compressed)
    std::string message;          //!< one line that names the file; empty when clean
};

/** Streams the objects of a rawlog, one at a time: observations (format 2), or CActionCollection
 * and CSensoryFrame in turns (format 1); plain or gz.
 *
 * Damage is never taken for the end of the file, as it is by MRPT's own reader: the checksum and
 * the length of gz data are verified, and sizes inside images, range images and strings are checked
 * against what the file holds before MRPT sees them, which would otherwise allocate without limit
 * or crash (in the classes of RGB-D, wheels, IMU, 2D laser and single cameras). A plain (not gz)
 * file that stops exactly between two objects cannot be told from a complete one. Not thread-safe.
 */
class RawlogReader
{
 public:
    /** \throws InputError if the file is missing, empty, unreadable or not a rawlog */
    explicit RawlogReader(const std::string& path, RawlogClasses classes = RawlogClasses::All);
    ~RawlogReader();
    RawlogReader(const RawlogReader&) = delete;
    RawlogReader& operator=(const RawlogReader&) = delete;

    /** The next object, or nullptr when there is none; ending() then says why. Never throws for
     * what is in the file. External images are not loaded. */
    [[nodiscard]] mrpt::serialization::CSerializable::Ptr next();

    [[nodiscard]] const RawlogEnding& ending() const;
    [[nodiscard]] std::size_t numObjects() const;  //!< delivered so far
    [[nodiscard]] double progress() const;         //!< fraction of the file consumed, 0 to 1
    [[nodiscard]] const std::string& path() const;

    /** Folder of external images and ranges by MRPT's rule: NAME_Images and variants, else
     * Images, beside the rawlog. */
    [[nodiscard]] const std::string& externalsDirectory() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace pointplane
