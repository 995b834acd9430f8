// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/RawlogReader.h>
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
/** Objects of this size are members of their own: images. */
constexpr std::size_t kOwnMember = 1U << 12U;

/** Of the object in it: the last field, little endian. */
[[nodiscard]] std::size_t sizeOfMember(const std::vector<std::uint8_t>& member)
{
    std::uint32_t size = 0;
    for (std::size_t i = 1; i <= sizeof(size) && i <= member.size(); ++i)
    {
        size = size << 8U | member[member.size() - i];
    }
    return size;
}
}  // namespace

struct RawlogWriter::Impl
{
    Impl(const std::string& thePath, const Options& theOptions)
        : options(theOptions), file(thePath, theOptions.compressionLevel)
    {
    }
    void requireOpen() const
    {
        if (closed)
        {
            throw std::logic_error("RawlogWriter::write after close: " + file.file().path());
        }
    }
    void count(std::size_t bytes)
    {
        ++numObjects;
        numBytes += bytes;
    }
    void nothingWaits() { objectsWaiting = bytesWaiting = 0; }
    void append(const void* bytes, std::size_t size);

    Options options;
    GzOutput file;
    bool closed{false};
    std::size_t numObjects{0};
    std::uint64_t numBytes{0};
    std::size_t objectsWaiting{0};  // in the member at hand
    std::size_t bytesWaiting{0};
};

void RawlogWriter::Impl::append(const void* bytes, std::size_t size)
{
    const bool alone = size >= kOwnMember;
    if (alone)
    {
        file.flush();
        nothingWaits();
    }
    file.write(bytes, size);
    count(size);
    bytesWaiting += size;
    if (alone || ++objectsWaiting >= options.flushEveryObjects ||
        bytesWaiting >= options.flushEveryBytes)
    {
        file.flush();
        nothingWaits();
    }
}

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
    impl_->requireOpen();
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
    impl_->append(buffer.getRawBufferData(), static_cast<std::size_t>(buffer.getTotalBytesCount()));
}

void RawlogWriter::write(const RawlogRecord& record)
{
    impl_->requireOpen();
    if (record.member.empty())
    {
        impl_->append(record.bytes.data(), record.bytes.size());
        return;
    }
    impl_->file.copyMember(record.member);
    impl_->count(sizeOfMember(record.member));
    impl_->nothingWaits();
}

void RawlogWriter::flush()
{
    impl_->file.flush();
    impl_->nothingWaits();
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
