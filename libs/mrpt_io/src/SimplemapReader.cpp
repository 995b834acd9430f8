// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/SimplemapReader.h>
#include <pointplane/mrpt_io/errors.h>

#include <mrpt/poses/CPosePDF.h>

#include <vector>

#include "GzInput.h"
#include "ObjectScanner.h"
#include "ReplayStream.h"
#include "other_file_type.h"

namespace pointplane
{
struct SimplemapReader::Impl
{
    Impl(const std::string& thePath, RawlogClasses theClasses)
        : path(thePath), classes(theClasses), in(thePath), scanner(in)
    {
    }

    [[nodiscard]] std::optional<SimplemapKeyFrame> next();
    [[nodiscard]] mrpt::serialization::CSerializable::Ptr object();
    [[nodiscard]] mrpt::serialization::CSerializable::Ptr askMrpt(const std::string& what);
    [[noreturn]] void fail(const std::string& problem) const;

    std::string path;
    RawlogClasses classes;
    GzInput in;
    ObjectScanner scanner;
    std::vector<std::uint8_t> bytes, room;
    ObjectScanner::MapStart map;
    std::uint32_t numRead{0};
    bool isAtEnd{false};  //!< nothing is left but the end of the file, which was checked
};

void SimplemapReader::Impl::fail(const std::string& problem) const
{
    // A plain file that stops inside an object ends "clean" as a file, but not as a map.
    const bool truncated = in.end() == GzInput::End::Truncated ||
                           (in.end() == GzInput::End::Clean && numRead < map.numKeyFrames);
    throw InputError(
        path + (truncated ? ": truncated" : ": damaged") + " at byte " +
        std::to_string(in.fileOffset()) + ", key frame " + std::to_string(numRead) + ": " +
        (in.problem().empty() ? problem : in.problem()));
}

/** Of a class whose sizes only MRPT knows; it believes what they say. */
mrpt::serialization::CSerializable::Ptr SimplemapReader::Impl::askMrpt(const std::string& what)
{
    const Checksums sums = classes == RawlogClasses::Known ? Checksums::None : checksumsOf(path);
    if (sums == Checksums::Wrong)
    {
        fail("the checksum is wrong, so this is not read: " + what);
    }
    if (sums == Checksums::None)
    {
        throw InputError(
            path + ": key frame " + std::to_string(numRead) + ": " + what +
            ", whose layout is not known, and the file has no checksum that would tell damage; if "
            "it is whole, compress it: gzip " +
            path);
    }
    scanner.restore(bytes);
    return deserialise(bytes, &in);
}

mrpt::serialization::CSerializable::Ptr SimplemapReader::Impl::object()
{
    try
    {
        if (!scanner.scan(bytes))
        {
            fail("fewer key frames than it says");
        }
    }
    catch (const ObjectScanner::Unknown& e)
    {
        return askMrpt(e.what());
    }
    catch (const ObjectScanner::OldFormat&)
    {
        if (!map.isOld)
        {
            throw;
        }
        return askMrpt("an object written before MRPT 0.5.5");
    }
    requireRoom(bytes.size(), room);
    return deserialise(bytes, nullptr);
}

std::optional<SimplemapKeyFrame> SimplemapReader::Impl::next()
{
    if (numRead == map.numKeyFrames)
    {
        if (!isAtEnd)
        {
            scanner.scanMapEnd(map, bytes);
            isAtEnd = true;
        }
        return std::nullopt;
    }
    SimplemapKeyFrame out;
    const auto pose = object();
    out.pose = std::dynamic_pointer_cast<mrpt::poses::CPose3DPDF>(pose);
    if (const auto flat = std::dynamic_pointer_cast<mrpt::poses::CPosePDF>(pose))  // version 0
    {
        out.pose.reset(mrpt::poses::CPose3DPDF::createFrom2D(*flat));
    }
    out.observations = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object());
    if (!out.pose || !out.observations)
    {
        fail("no pose and sensory frame where they belong");
    }
    if (map.version >= 2)
    {
        scanner.scanTwist(bytes);
    }
    ++numRead;
    return out;
}

SimplemapReader::SimplemapReader(const std::string& path, RawlogClasses classes)
    : impl_(std::make_unique<Impl>(path, classes))
{
    try
    {
        impl_->map = impl_->scanner.scanMapStart(impl_->bytes);
    }
    catch (const ObjectScanner::Problem& e)
    {
        const auto type = otherFileType(path);
        throw InputError(
            type ? path + ": is " + type->name + ", not a .simplemap"
                 : path + ": " + e.what() + " (is it a .simplemap?)");
    }
}

SimplemapReader::~SimplemapReader() = default;

std::optional<SimplemapKeyFrame> SimplemapReader::next()
{
    try
    {
        return impl_->next();
    }
    catch (const InputError&)
    {
        throw;
    }
    catch (const std::exception& e)
    {
        if (isOutOfMemory(e))
        {
            throw;  // says nothing about the file
        }
        impl_->fail(oneLine(e));
    }
}
}  // namespace pointplane
