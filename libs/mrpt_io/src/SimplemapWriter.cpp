// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/mrpt_io/ScanWriter.h>
#include <pointplane/mrpt_io/SimplemapWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/external_range.h>

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/obs/T3DPointsProjectionParams.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "GzOutput.h"

namespace pointplane
{
struct SimplemapWriter::Impl
{
    explicit Impl(const std::string& thePath) : file(thePath, 1) {}
    GzOutput file;
    std::vector<std::pair<mrpt::poses::CPose3DPDFGaussian, mrpt::obs::CObservation3DRangeScan::Ptr>>
        keyframes;
    bool isClosed{false};
};

mrpt::obs::CObservation3DRangeScan::Ptr withPoints(const mrpt::obs::CObservation3DRangeScan& scan)
{
    auto out = mrpt::obs::CObservation3DRangeScan::Create(scan);
    if (!out->hasRangeImage)
    {
        return out;  // of colour alone
    }
    if (out->rangeImage_isExternallyStored() && out->rangeImage.size() == 0)
    {
        const auto readings =
            readExternalRange(out->rangeImage_getExternalStorageFileAbsolutePath(""));
        out->rangeImage_forceResetExternalStorage();
        out->rangeImage = readings;
    }
    // MRPT takes 0 alone for no reading.
    std::uint16_t* readings = out->rangeImage.data();
    std::replace(readings, readings + out->rangeImage.size(), kSaturatedDepth, std::uint16_t{0});
    try
    {
        mrpt::obs::T3DPointsProjectionParams params;
        params.takeIntoAccountSensorPoseOnRobot = false;
        out->unprojectInto(*out, params);
    }
    catch (const std::exception& e)
    {
        throw InputError("cannot compute a point cloud: " + oneLine(e));
    }
    return out;
}

SimplemapWriter::SimplemapWriter(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
SimplemapWriter::~SimplemapWriter() = default;

void SimplemapWriter::add(
    const mrpt::poses::CPose3DPDFGaussian& pose,
    const mrpt::obs::CObservation3DRangeScan::Ptr& scan)
{
    POINTPLANE_CHECK(scan, "a key frame needs a scan");
    impl_->keyframes.emplace_back(pose, scan);
}

std::size_t SimplemapWriter::size() const { return impl_->keyframes.size(); }

void SimplemapWriter::close()
{
    if (impl_->isClosed)
    {
        return;
    }
    // The layout of a serialised object: class name, version, contents, end mark.
    mrpt::io::CMemoryStream head;
    auto archive = mrpt::serialization::archiveFrom(head);
    const std::string name = "mrpt::maps::CSimpleMap";
    archive << static_cast<std::uint8_t>(name.size() | 0x80U);
    archive.WriteBuffer(name.data(), name.size());
    archive << std::uint8_t{1} << static_cast<std::uint32_t>(impl_->keyframes.size());
    GzOutput& file = impl_->file;
    const auto put = [&file](const mrpt::io::CMemoryStream& bytes)
    { file.write(bytes.getRawBufferData(), static_cast<std::size_t>(bytes.getTotalBytesCount())); };
    put(head);
    for (const auto& [pose, scan] : impl_->keyframes)
    {
        mrpt::obs::CSensoryFrame frame;
        frame.insert(withPoints(*scan));
        mrpt::io::CMemoryStream body;
        auto bodyArchive = mrpt::serialization::archiveFrom(body);
        bodyArchive << pose << frame;
        put(body);
    }
    constexpr std::uint8_t kEndMark = 0x88;
    file.write(&kEndMark, 1);
    file.commit();
    impl_->isClosed = true;
}

void SimplemapWriter::discard() noexcept { impl_->file.discard(); }
}  // namespace pointplane
