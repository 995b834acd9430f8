// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/RawlogReader.h>

#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>

#include <memory>
#include <optional>
#include <string>

namespace pointplane
{
struct SimplemapKeyFrame
{
    mrpt::poses::CPose3DPDF::Ptr pose;           //!< of the robot in the map
    mrpt::obs::CSensoryFrame::Ptr observations;  //!< external images are not loaded
};

/** Streams the key frames of MRPT's CSimpleMap (plain or gz), one at a time.
 *
 * MRPT's own reader believes the sizes in the file and so crashes on damage, and needs memory for
 * the whole map. This one checks sizes and checksums as RawlogReader does. Objects whose layout is
 * not known here are left to MRPT only where the file has checksums and they are right. Not
 * thread-safe. */
class SimplemapReader
{
 public:
    /** \throws InputError if the file is missing, empty, unreadable or not a map */
    explicit SimplemapReader(const std::string& path, RawlogClasses classes = RawlogClasses::All);
    ~SimplemapReader();
    SimplemapReader(const SimplemapReader&) = delete;
    SimplemapReader& operator=(const SimplemapReader&) = delete;

    /** The next key frame; none after the last one, the file being whole then.
     * \throws InputError that names file, byte and key frame, if the file is damaged, truncated or
     * holds what cannot be read; std::bad_alloc where memory is short */
    [[nodiscard]] std::optional<SimplemapKeyFrame> next();

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace pointplane
