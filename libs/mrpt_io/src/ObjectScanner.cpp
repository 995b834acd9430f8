// SPDX-License-Identifier: BSD-3-Clause
#include "ObjectScanner.h"

#include <pointplane/mrpt_io/errors.h>

#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>

#include <algorithm>
#include <cstring>

#include "ReplayStream.h"

namespace pointplane
{
namespace
{
constexpr std::uint8_t kEndFlag = 0x88;
constexpr std::uint64_t kMaxPixels = 1ULL << 26U;  // 8192 x 8192
constexpr std::uint64_t kMaxString = 1ULL << 20U;
constexpr std::uint64_t kMaxObjects = 1ULL << 16U;
constexpr std::uint64_t kChunk = 1ULL << 20U;
constexpr int kMaxDepth = 4;

using Problem = ObjectScanner::Problem;

void require(bool condition, const std::string& problem)
{
    if (!condition)
    {
        throw Problem(problem);
    }
}

std::uint64_t numPixels(std::uint64_t width, std::uint64_t height)
{
    require(
        width <= kMaxPixels && height <= kMaxPixels && width * height <= kMaxPixels,
        "an image of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
    return width * height;
}
}  // namespace

void ObjectScanner::copy(std::uint64_t size)
{
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

template <class T>
T ObjectScanner::copyValue()
{
    copy(sizeof(T));
    T value;
    std::memcpy(&value, bytes_->data() + bytes_->size() - sizeof(T), sizeof(T));
    return value;
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

ObjectScanner::Header ObjectScanner::copyHeader()
{
    Header header;
    header.begin = bytes_->size();
    const auto length = copyValue<std::uint8_t>();
    // Without the high bit: the format before MRPT 0.5.5, older than any RGB-D sensor.
    require((length & 0x80U) != 0, "not the start of an object");
    const std::size_t size = length & 0x7FU;
    copy(size);
    header.className.assign(
        reinterpret_cast<const char*>(bytes_->data()) + bytes_->size() - size, size);
    const bool isName = size > 0 && std::all_of(
                                        header.className.begin(),
                                        header.className.end(),
                                        [](char c) { return c > 0x20 && c < 0x7f; });
    require(isName, "not the start of an object");
    if (header.className != "nullptr")
    {
        header.version = copyValue<std::uint8_t>();
    }
    if (const auto colon = header.className.rfind("::"); colon != std::string::npos)
    {
        header.className.erase(0, colon + 2);
    }
    return header;
}

void ObjectScanner::copyEndFlag(const Header& header)
{
    require(
        copyValue<std::uint8_t>() == kEndFlag,
        "an object of class " + header.className + " without its end mark");
}

bool ObjectScanner::scan(std::vector<std::uint8_t>& bytes)
{
    bytes_ = &bytes;
    bytes.clear();
    resolutions_.clear();
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

void ObjectScanner::copyAnyObject(int depth)
{
    require(depth < kMaxDepth, "objects nested too deeply");
    copyBody(copyHeader(), depth);
}

void ObjectScanner::copyObject(const char* expectedClass)
{
    const Header header = copyHeader();
    require(
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

void ObjectScanner::copyBody(const Header& header, int depth)
{
    const std::string& name = header.className;
    const int version = header.version;
    if (name == "CObservation3DRangeScan" && version <= 10)
    {
        range3DScan(version);
    }
    else if (name == "CSensoryFrame" && version == 2)
    {
        copyObjects(depth);
    }
    else if (name == "CActionCollection" && version == 0)
    {
        copyObjects(depth);
    }
    else if (name == "CActionRobotMovement3D" && version == 1)
    {
        copyValue<std::uint32_t>();  // estimation method
        copyObject("CPose3DPDFGaussian");
        copyArray(copyValue<std::uint32_t>(), sizeof(std::uint8_t));  // velocities known
        copyArray(copyValue<std::uint32_t>(), sizeof(float));         // velocities
        copy(sizeof(std::uint64_t));                                  // time stamp
    }
    else if (name == "CObservationRobotPose" && version == 1)
    {
        copyObject("CPose3DPDFGaussian");
        copyString();
        copy(sizeof(std::uint64_t));
        copyObject("CPose3D");
    }
    else if (name == "CObservationComment" && version == 0)
    {
        copyString();
        copy(sizeof(std::uint64_t));
    }
    else if (name == "CPose3DPDFGaussian" && version == 1)
    {
        copyObject("CPose3D");
        copyArray(21, sizeof(double));
    }
    else if (name == "CPose3D")
    {
        pose3D(version);
    }
    else if (name == "CImage")
    {
        image(version);
    }
    else if (name == "TCamera")
    {
        camera(version);
    }
    else if (name == "CMatrixF" && version == 0)
    {
        const auto rows = copyValue<std::uint32_t>();
        copyArray(numPixels(copyValue<std::uint32_t>(), rows), sizeof(float));
    }
    else
    {
        opaque(header);
        return;
    }
    copyEndFlag(header);
}

void ObjectScanner::range3DScan(int version)
{
    copy(sizeof(float));  // maxRange
    copyObject("CPose3D");
    if (version == 0 || copyBool())
    {
        const auto n = copyValue<std::uint32_t>();
        copyArray(n, 3 * sizeof(float));
        if (version == 0)
        {
            copyArray(n, 1);
        }
        if (version >= 8)
        {
            copyArray(n, 2 * sizeof(std::uint16_t));
        }
    }
    if (version >= 1)
    {
        rangeImage(version);
    }
    copy(sizeof(float) + sizeof(std::uint64_t));  // stdError, time stamp
    copyString();
    if (version >= 3)
    {
        copyBool();  // external points and their file
        copyString();
        copyBool();  // external ranges and their file
        copyString();
    }
    if (version >= 5)
    {
        copyBool();  // range_is_depth
    }
    if (version >= 6)
    {
        copy(sizeof(std::int8_t));  // intensity channel
    }
    if (version >= 7 && copyBool())
    {
        pixelLabels();
    }
    if (version >= 10)
    {
        const int numLayers = copyValue<std::uint8_t>();
        for (int i = 0; i < numLayers; ++i)
        {
            copyString();
            const auto rows = copyValue<std::uint32_t>();
            copyArray(numPixels(copyValue<std::uint32_t>(), rows), sizeof(std::uint16_t));
        }
    }
}

void ObjectScanner::rangeImage(int version)
{
    Resolution range;
    const bool hasRange = copyBool();
    if (version >= 9)
    {
        copy(sizeof(float));  // rangeUnits
    }
    if (hasRange && version < 9)
    {
        copyObject("CMatrixF");
    }
    else if (hasRange)
    {
        range.rows = copyValue<std::uint32_t>();
        range.cols = copyValue<std::uint32_t>();
        copyArray(numPixels(range.cols, range.rows), sizeof(std::uint16_t));
    }
    if (copyBool())
    {
        copyObject("CImage");  // intensity
    }
    if (copyBool())
    {
        copyObject("CImage");  // confidence
    }
    if (version >= 2)
    {
        copyObject("TCamera");
        exchangeResolution(range);
    }
    if (version >= 4)
    {
        copyObject("TCamera");
        copyObject("CPose3D");
    }
}

void ObjectScanner::exchangeResolution(const Resolution& range)
{
    Resolution camera;
    std::uint8_t* at = bytes_->data() + cameraResolutionAt_;
    std::memcpy(&camera, at, sizeof(camera));
    resolutions_.push_back(camera);
    if (range.rows > 0 && range.cols > 0)
    {
        std::memcpy(at, &range, sizeof(range));
    }
}

void ObjectScanner::pixelLabels()
{
    throw Problem("a range scan with pixel labels, which are not supported");
}

void ObjectScanner::image(int version)
{
    require(
        version >= 7 && version <= 9,
        "an image of serialisation version " + std::to_string(version) + " (7 to 9 are supported)");
    if (copyBool())
    {
        copyString();  // external file
        return;
    }
    if (copyBool())
    {
        colourPixels(version);
    }
    else
    {
        grayPixels(version);
    }
}

void ObjectScanner::grayPixels(int version)
{
    const auto width = copyValue<std::uint32_t>();
    const auto height = copyValue<std::uint32_t>();
    copy(sizeof(std::int32_t));  // origin
    const auto size = copyValue<std::uint32_t>();
    std::uint64_t pixelSize = 1;
    if (version >= 9)
    {
        // OpenCV's depth codes: 8, 16, 32 and 64 bit.
        static constexpr std::uint64_t kSizes[] = {1, 1, 2, 2, 4, 4, 8};
        const auto depth = copyValue<std::uint32_t>();
        require(depth < std::size(kSizes), "an image of unknown depth");
        pixelSize = kSizes[depth];
    }
    require(numPixels(width, height) * pixelSize == size, "an image whose sizes disagree");
    require(!copyBool(), "a zip-compressed image, which MRPT 2 cannot read");
    copy(size);
}

void ObjectScanner::colourPixels(int version)
{
    // Negative: raw pixels. Positive: JPEG follows.
    const auto width = copyValue<std::int32_t>();
    const auto height = copyValue<std::int32_t>();
    const auto magnitude = [](std::int32_t v)
    { return static_cast<std::uint64_t>(v < 0 ? -static_cast<std::int64_t>(v) : v); };
    const std::uint64_t pixels = numPixels(magnitude(width), magnitude(height));
    require((width < 0) == (height < 0) || pixels == 0, "an image whose sizes disagree");
    if (version >= 8 && width < 0)
    {
        copy(pixels * 3);
    }
    else if (width > 0 && height > 0)
    {
        const auto size = copyValue<std::uint32_t>();
        require(size <= pixels * 6 + 65536, "a JPEG image larger than its pixels");
        copy(size);
    }
}

void ObjectScanner::camera(int version)
{
    require(
        version >= 2 && version <= 6,
        "a camera of serialisation version " + std::to_string(version) + " (2 to 6 are supported)");
    const std::uint64_t numDistortion = version >= 3 ? 8 : 5;
    const std::uint64_t numIntrinsics = version >= 4 ? 4 : 9;
    copy((1 + numDistortion) * sizeof(double));
    if (version < 4)
    {
        copy(2 * sizeof(std::uint32_t));  // rows and columns of the matrix
    }
    copy(numIntrinsics * sizeof(double));
    cameraResolutionAt_ = bytes_->size();
    copy(2 * sizeof(std::uint32_t));  // rows, columns
    if (version >= 5)
    {
        copyString();
    }
    if (version >= 6)
    {
        copy(sizeof(std::uint8_t));
    }
}

void ObjectScanner::pose3D(int version)
{
    require(
        version == 2 || version == 3,
        "a pose of serialisation version " + std::to_string(version) + " (2, 3 are supported)");
    // Translation and rotation matrix; a quaternion in version 2.
    copyArray(version == 3 ? 12 : 7, sizeof(double));
}

void ObjectScanner::opaque(const Header& header)
{
    // MRPT reads the header again from our copy, then the rest from the file; all is recorded.
    ReplayStream stream(*bytes_, header.begin, &in_);
    auto archive = mrpt::serialization::archiveFrom(static_cast<mrpt::io::CStream&>(stream));
    try
    {
        (void)archive.ReadObject();
    }
    catch (const std::exception& e)
    {
        require(in_.problem().empty(), in_.problem());
        throw Problem("an object of class " + header.className + ": " + oneLine(e));
    }
}
}  // namespace pointplane
