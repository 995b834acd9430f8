// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/RawlogWriter.h>
#include <pointplane/mrpt_io/errors.h>

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "GzOutput.h"

namespace pointplane
{
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
    archive << object;
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
