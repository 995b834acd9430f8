// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <cstddef>
#include <memory>
#include <string>

namespace pointplane
{
/** Writes key frames as MRPT's CSimpleMap (pose PDF and sensory frame each), which observations2map
 * turns into maps. Each scan gets its point cloud, without which map builders skip it.
 *
 * The file has the class's first version, which every MRPT 2 reads. It begins with the number of
 * key frames, so these are kept in memory, without their clouds, until close(). */
class SimplemapWriter
{
 public:
    /** \throws EnvironmentError if `<path>.partial` cannot be created */
    explicit SimplemapWriter(const std::string& path);
    ~SimplemapWriter();
    SimplemapWriter(const SimplemapWriter&) = delete;
    SimplemapWriter& operator=(const SimplemapWriter&) = delete;

    /** Adds a key frame. \param pose of the robot in the map
     * \throws std::invalid_argument without a scan */
    void add(
        const mrpt::poses::CPose3DPDFGaussian& pose,
        const mrpt::obs::CObservation3DRangeScan::Ptr& scan);

    /** Writes everything and renames the file to its name. \throws EnvironmentError, and InputError
     * as withPoints() */
    void close();
    /** Removes the partial file. */
    void discard() noexcept;

    [[nodiscard]] std::size_t size() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/** A copy of a scan with its point cloud (sensor frame), in which no reading is 0. Ranges that were
 * in a file (of MRPT's folder, if its name is relative) are in memory. \throws InputError if that
 * file cannot be read, or the cloud cannot be computed */
[[nodiscard]] mrpt::obs::CObservation3DRangeScan::Ptr withPoints(
    const mrpt::obs::CObservation3DRangeScan& scan);
}  // namespace pointplane
