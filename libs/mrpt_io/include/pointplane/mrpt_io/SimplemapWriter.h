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
 * Written in the class's first version, which every MRPT 2 reads. Key frames are kept until close()
 * without their clouds, as the file begins with their number. */
class SimplemapWriter
{
 public:
    /** \throws EnvironmentError if `<path>.partial` cannot be created */
    explicit SimplemapWriter(const std::string& path);
    ~SimplemapWriter();
    SimplemapWriter(const SimplemapWriter&) = delete;
    SimplemapWriter& operator=(const SimplemapWriter&) = delete;

    void add(
        const mrpt::poses::CPose3DPDFGaussian& pose,
        const mrpt::obs::CObservation3DRangeScan::Ptr& scan);

    /** Writes everything and renames the file to its name. \throws EnvironmentError */
    void close();
    /** Removes the partial file. */
    void discard() noexcept;

    [[nodiscard]] std::size_t size() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/** A copy with its point cloud, sensor frame, and its ranges in memory if they were in a file.
 * \throws InputError if that file cannot be read, or the cloud cannot be computed */
[[nodiscard]] mrpt::obs::CObservation3DRangeScan::Ptr withPoints(
    const mrpt::obs::CObservation3DRangeScan& scan);
}  // namespace pointplane
