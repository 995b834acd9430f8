// SPDX-License-Identifier: BSD-3-Clause
#include "ObjectScanner.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cstring>

namespace pointplane
{
namespace
{
constexpr std::uint8_t kEndFlag = 0x88;
constexpr std::uint64_t kMaxString = 1ULL << 26U;
constexpr std::uint64_t kMaxObjects = 1ULL << 16U;
constexpr int kMaxDepth = 4;

/** That this MRPT reads: of 2.5 it is 0, of 2.14 it is 1. */
std::uint8_t commentVersion()
{
    mrpt::io::CMemoryStream stream;
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive << mrpt::obs::CObservationComment();
    const auto* bytes = static_cast<const std::uint8_t*>(stream.getRawBufferData());
    const std::size_t nameSize = bytes[0] & 0x7FU;
    return bytes[1 + nameSize];
}

using scanning::kMaxPixels;
using scanning::require;
using scanning::requireKnown;
}  // namespace

void ObjectScanner::copy(std::uint64_t size)
{
    constexpr std::uint64_t kChunk = 1ULL << 20U;
    // In steps, so that a wrong length costs no more memory than the file has bytes.
    while (size > 0)
    {
        const auto step = static_cast<std::size_t>(std::min(size, kChunk));
        const std::size_t at = bytes_->size();
        bytes_->resize(at + step);
        const std::size_t n = in_.read(bytes_->data() + at, step);
        if (n < step)
        {
            bytes_->resize(at + n);
            throw Problem(
                in_.problem().empty() ? "the file stops inside an object" : in_.problem());
        }
        size -= step;
    }
}

bool ObjectScanner::copyBool()
{
    const auto value = copyValue<std::uint8_t>();
    require(value <= 1, "a flag that is neither true nor false");
    return value == 1;
}

void ObjectScanner::copyString()
{
    const auto size = copyValue<std::uint32_t>();
    require(size <= kMaxString, "a text of " + std::to_string(size) + " bytes");
    copy(size);
}

void ObjectScanner::copyArray(std::uint64_t count, std::uint64_t elementSize)
{
    require(count <= kMaxPixels, "an array of " + std::to_string(count) + " elements");
    copy(count * elementSize);
}

std::string ObjectScanner::copyClassName(std::size_t size)
{
    copy(size);
    std::string name(reinterpret_cast<const char*>(bytes_->data()) + bytes_->size() - size, size);
    const auto isPlain = [](char c) { return c > 0x20 && c < 0x7f; };
    require(
        size > 0 && std::all_of(name.begin(), name.end(), isPlain), "not the start of an object");
    if (const auto colon = name.rfind("::"); colon != std::string::npos)
    {
        name.erase(0, colon + 2);
    }
    return name;
}

ObjectScanner::Header ObjectScanner::copyHeader()
{
    Header header;
    header.begin = bytes_->size();
    const auto length = copyValue<std::uint8_t>();
    // Without the high bit: the format before MRPT 0.5.5, older than any RGB-D sensor.
    if ((length & 0x80U) == 0)
    {
        throw OldFormat("not the start of an object");
    }
    header.className = copyClassName(length & 0x7FU);
    if (header.className != "nullptr")
    {
        header.version = copyValue<std::uint8_t>();
    }
    return header;
}

void ObjectScanner::copyEndFlag(const Header& header)
{
    require(
        copyValue<std::uint8_t>() == kEndFlag,
        "an object of class " + header.className + " without its end mark");
}

void ObjectScanner::begin(std::vector<std::uint8_t>& bytes)
{
    bytes_ = &bytes;
    bytes.clear();
    resolutions_.clear();
    edits_.clear();
}

bool ObjectScanner::scan(std::vector<std::uint8_t>& bytes)
{
    begin(bytes);
    try
    {
        copyAnyObject(0);
    }
    catch (const Problem&)
    {
        if (bytes.empty() && in_.end() == GzInput::End::Clean)
        {
            return false;
        }
        throw;
    }
    return true;
}

void ObjectScanner::noteEdit(std::size_t at, std::size_t originalSize, std::size_t size)
{
    const auto from = bytes_->begin() + static_cast<std::ptrdiff_t>(at);
    edits_.push_back({at, size, {from, from + static_cast<std::ptrdiff_t>(originalSize)}});
}

void ObjectScanner::restore(std::vector<std::uint8_t>& bytes) const
{
    for (auto edit = edits_.rbegin(); edit != edits_.rend(); ++edit)
    {
        const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(edit->at);
        if (edit->size == edit->original.size())
        {
            std::copy(edit->original.begin(), edit->original.end(), at);
            continue;
        }
        const auto next = bytes.erase(at, at + static_cast<std::ptrdiff_t>(edit->size));
        bytes.insert(next, edit->original.begin(), edit->original.end());
    }
}

void ObjectScanner::copyAnyObject(int depth)
{
    require(depth < kMaxDepth, "objects nested too deeply");
    copyBody(copyHeader(), depth);
}

void ObjectScanner::copyObject(const char* expectedClass)
{
    const Header header = copyHeader();
    requireKnown(
        header.className == expectedClass,
        "class " + header.className + " where " + expectedClass + " belongs");
    copyBody(header, 0);
}

void ObjectScanner::copyObjects(int depth)
{
    const auto count = copyValue<std::uint32_t>();
    require(count <= kMaxObjects, "a list of " + std::to_string(count) + " objects");
    for (std::uint32_t i = 0; i < count; ++i)
    {
        copyAnyObject(depth + 1);
    }
}

void ObjectScanner::sensoryFrame(int version, int depth)
{
    if (version < 2)
    {
        copy(version == 0 ? 4 : 12);  // identifier, time stamp
        require(copyValue<std::uint32_t>() <= kMaxObjects, "a frame of too many observations");
        throw Unknown("class CSensoryFrame, version " + std::to_string(version));
    }
    copyObjects(depth);
}

void ObjectScanner::movement3D()
{
    copyValue<std::uint32_t>();  // estimation method
    copyObject("CPose3DPDFGaussian");
    copyArray(copyValue<std::uint32_t>(), sizeof(std::uint8_t));  // velocities known
    copyArray(copyValue<std::uint32_t>(), sizeof(float));         // velocities
    copy(sizeof(std::uint64_t));                                  // time stamp
}

void ObjectScanner::robotPose()
{
    copyObject("CPose3DPDFGaussian");
    copyString();                 // label
    copy(sizeof(std::uint64_t));  // time stamp
    copyObject("CPose3D");
}

void ObjectScanner::comment(int version)
{
    copyString();
    copy(sizeof(std::uint64_t));  // time stamp
    if (version == 1)
    {
        copyString();  // label
    }
}

void ObjectScanner::copyBody(const Header& header, int depth)
{
    static const std::uint8_t kCommentVersion = commentVersion();
    const std::string& name = header.className;
    const int version = header.version;
    if (name == "CObservation3DRangeScan" && (version == 9 || version == 10))
    {
        range3DScan(version);
    }
    else if (name == "CSensoryFrame" && version <= 2)
    {
        sensoryFrame(version, depth);
    }
    else if (name == "CActionCollection" && version == 0)
    {
        copyObjects(depth);
    }
    else if (name == "CActionRobotMovement3D" && version == 1)
    {
        movement3D();
    }
    else if (name == "CObservationRobotPose" && version == 1)
    {
        robotPose();
    }
    else if (name == "CObservationComment" && version <= std::min<int>(kCommentVersion, 1))
    {
        comment(version);
    }
    else if (!partOfOthers(header) && !otherSensor(header, depth))
    {
        throw Unknown("class " + name + ", version " + std::to_string(version));
    }
    copyEndFlag(header);
}

bool ObjectScanner::partOfOthers(const Header& header)
{
    const std::string& name = header.className;
    if (name == "CPose3DPDFGaussian" && header.version == 1)
    {
        copyObject("CPose3D");
        copyArray(21, sizeof(double));
    }
    else if (name == "CPose3D")
    {
        pose3D(header.version);
    }
    else if (name == "CImage")
    {
        image(header.version);
    }
    else if (name == "TCamera")
    {
        camera(header.version);
    }
    else
    {
        return false;
    }
    return true;
}
}  // namespace pointplane
