// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/RawlogWriter.h>
#include <pointplane/mrpt_io/errors.h>

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>

#include <stdexcept>

#include "GzOutput.h"

namespace pointplane
{
namespace
{
/** Version 0 of the class, which every MRPT reads. MRPT 2.14 writes version 1, which adds the label
 * and which MRPT 2.5 refuses. */
void writeComment(
    const mrpt::obs::CObservationComment& comment, mrpt::serialization::CArchive& archive)
{
    const std::string name = "mrpt::obs::CObservationComment";
    archive << static_cast<std::uint8_t>(0x80U | name.size());
    archive.WriteBuffer(name.data(), name.size());
    archive << std::uint8_t{0} << comment.text
            << static_cast<std::uint64_t>(comment.timestamp.time_since_epoch().count())
            << std::uint8_t{0x88};
}
}  // namespace

struct RawlogWriter::Impl
{
    Impl(const std::string& thePath, const Options& theOptions)
        : options(theOptions), file(thePath, theOptions.compressionLevel)
    {
    }
    Options options;
    GzOutput file;
    bool closed{false};
    std::size_t numObjects{0};
    std::uint64_t numBytes{0};
    std::size_t objectsSinceFlush{0};
    std::size_t bytesSinceFlush{0};
};

RawlogWriter::RawlogWriter(const std::string& path, const Options& options)
    : impl_(std::make_unique<Impl>(path, options))
{
}

RawlogWriter::~RawlogWriter()
{
    try
    {
        if (!impl_->closed)
        {
            flush();
        }
    }
    catch (const std::exception&)  // the file is marked as partial in any case
    {
    }
}

void RawlogWriter::write(const mrpt::serialization::CSerializable& object)
{
    if (impl_->closed)
    {
        throw std::logic_error("RawlogWriter::write after close: " + path());
    }
    mrpt::io::CMemoryStream buffer;
    auto archive = mrpt::serialization::archiveFrom(buffer);
    const auto* comment = dynamic_cast<const mrpt::obs::CObservationComment*>(&object);
    if (comment != nullptr && comment->sensorLabel.empty())
    {
        writeComment(*comment, archive);
    }
    else
    {
        archive << object;
    }
    const auto size = static_cast<std::size_t>(buffer.getTotalBytesCount());
    impl_->file.write(buffer.getRawBufferData(), size);
    ++impl_->numObjects;
    impl_->numBytes += size;
    impl_->bytesSinceFlush += size;
    if (++impl_->objectsSinceFlush >= impl_->options.flushEveryObjects ||
        impl_->bytesSinceFlush >= impl_->options.flushEveryBytes)
    {
        flush();
    }
}

void RawlogWriter::flush()
{
    impl_->file.flush();
    impl_->objectsSinceFlush = 0;
    impl_->bytesSinceFlush = 0;
}

void RawlogWriter::close()
{
    if (!impl_->closed)
    {
        impl_->file.commit();
        impl_->closed = true;
    }
}

void RawlogWriter::discard() noexcept
{
    impl_->file.discard();
    impl_->closed = true;
}

const std::string& RawlogWriter::path() const { return impl_->file.file().path(); }
std::string RawlogWriter::partialPath() const { return impl_->file.file().writtenPath(); }
std::size_t RawlogWriter::numObjects() const { return impl_->numObjects; }
std::uint64_t RawlogWriter::numBytes() const { return impl_->numBytes; }
}  // namespace pointplane
