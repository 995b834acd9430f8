// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/RawlogWriter.h>
#include <pointplane/mrpt_io/errors.h>

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

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
        : path(thePath),
          partialPath(thePath + ".partial"),
          options(theOptions),
          file(std::make_unique<GzOutput>(partialPath, theOptions.compressionLevel))
    {
    }
    std::string path;
    std::string partialPath;
    Options options;
    std::unique_ptr<GzOutput> file;  // empty once closed
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
        if (impl_->file)
        {
            flush();
        }
    }
    catch (const EnvironmentError&)  // the file is marked as partial in any case
    {
    }
}

void RawlogWriter::write(const mrpt::serialization::CSerializable& object)
{
    if (!impl_->file)
    {
        throw std::logic_error("RawlogWriter::write after close: " + impl_->path);
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
    impl_->file->write(buffer.getRawBufferData(), size);
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
    impl_->file->flush();
    impl_->objectsSinceFlush = 0;
    impl_->bytesSinceFlush = 0;
}

void RawlogWriter::close()
{
    if (!impl_->file)
    {
        return;
    }
    impl_->file->finish();
    impl_->file.reset();
    if (std::rename(impl_->partialPath.c_str(), impl_->path.c_str()) != 0)
    {
        throw EnvironmentError(
            "cannot rename " + impl_->partialPath + " to " + impl_->path + ": " +
            std::strerror(errno));
    }
}

const std::string& RawlogWriter::path() const { return impl_->path; }
const std::string& RawlogWriter::partialPath() const { return impl_->partialPath; }
std::size_t RawlogWriter::numObjects() const { return impl_->numObjects; }
std::uint64_t RawlogWriter::numBytes() const { return impl_->numBytes; }
}  // namespace pointplane
