// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/read_errors.h>
#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/image_file.h>
#include <pointplane/odometry/robot_mask.h>

#include <opencv2/imgcodecs.hpp>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <stdexcept>
#include <vector>

#include <turbojpeg.h>
#include <zlib.h>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

constexpr const char* kCut = "stops before the end of the image";

[[nodiscard]] std::uint32_t bigEndian(const unsigned char* bytes)
{
    return static_cast<std::uint32_t>(bytes[0]) << 24U |
           static_cast<std::uint32_t>(bytes[1]) << 16U |
           static_cast<std::uint32_t>(bytes[2]) << 8U | bytes[3];
}

/** Chunks of length, type, data and checksum (of type and data), up to IEND. */
[[nodiscard]] const char* problemOfPng(const Bytes& bytes)
{
    constexpr std::size_t kSignature = 8, kAround = 12;
    for (std::size_t at = kSignature;;)
    {
        if (bytes.size() - at < kAround || bigEndian(&bytes[at]) > bytes.size() - at - kAround)
        {
            return kCut;
        }
        const std::uint32_t length = bigEndian(&bytes[at]);
        const unsigned char* type = &bytes[at + 4];
        if (::crc32(0, type, length + 4) != bigEndian(type + 4 + length))
        {
            return "is damaged: a checksum is wrong";
        }
        if (std::memcmp(type, "IEND", 4) == 0)
        {
            return nullptr;
        }
        at += kAround + length;
    }
}

/** Segments of FF, marker and length; coded data, in which FF is followed by 0 or a restart, after
 * those called SOS; at last EOI. A thumbnail with an end of its own is inside a segment. */
[[nodiscard]] const char* problemOfJpeg(const Bytes& bytes)
{
    constexpr unsigned char kScan = 0xDA, kEnd = 0xD9;
    const auto isData = [](unsigned char marker)
    { return marker == 0 || marker == 0xFF || (marker >= 0xD0 && marker <= 0xD7); };
    for (std::size_t at = 2; at + 1 < bytes.size();)
    {
        if (bytes[at] != 0xFF || isData(bytes[at + 1]))
        {
            ++at;
            continue;
        }
        const unsigned char marker = bytes[at + 1];
        if (marker == kEnd)
        {
            return nullptr;
        }
        if (at + 3 >= bytes.size())
        {
            break;
        }
        const std::size_t length = bytes[at + 2] * 256U + bytes[at + 3];
        at += 2 + (marker == kScan ? 0 : length);
    }
    return kCut;
}

[[nodiscard]] const char* problemOf(const Bytes& bytes)
{
    const auto startsWith = [&](const char* start, std::size_t size)
    { return bytes.size() >= size && std::memcmp(bytes.data(), start, size) == 0; };
    return bytes.empty()                        ? "is empty"
           : startsWith("\x89PNG\r\n\x1A\n", 8) ? problemOfPng(bytes)
           : startsWith("\xFF\xD8", 2)          ? problemOfJpeg(bytes)
                                                : nullptr;
}

[[nodiscard]] Bytes bytesOf(const std::string& path)
{
    std::error_code error;
    const fs::path folder = fs::path(path).parent_path();
    if (!folder.empty() && fs::status(folder, error).type() == fs::file_type::not_found)
    {
        throw InputError("cannot open " + folder.string() + ": no such folder");
    }
    if (!fs::is_regular_file(path, error))
    {
        throw InputError("cannot open " + path + ": " + whyNoFile(path));
    }
    std::ifstream file(path, std::ios::binary);
    Bytes bytes = readAll<Bytes>(file);
    if (!file.is_open() || file.bad())
    {
        throw InputError("cannot read " + path + ": " + std::strerror(errno));
    }
    return bytes;
}
/** By TurboJPEG: OpenCV would start all of its coders, of which GDAL's ends the process where
 * memory is short. */
[[nodiscard]] Bytes jpegOf(const cv::Mat& bgr, int quality)
{
    const std::unique_ptr<void, int (*)(tjhandle)> coder(tjInitCompress(), tjDestroy);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    const bool isWritten = coder && tjCompress2(
                                        coder.get(),
                                        bgr.data,
                                        bgr.cols,
                                        static_cast<int>(bgr.step),
                                        bgr.rows,
                                        TJPF_BGR,
                                        &data,
                                        &size,
                                        TJSAMP_420,
                                        quality,
                                        TJFLAG_ACCURATEDCT) == 0;
    const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(data, tjFree);
    if (!isWritten)
    {
        throw std::bad_alloc();
    }
    return {data, data + size};
}
}  // namespace

cv::Mat readImageFile(const std::string& path, int flags)
{
    return decodedImage(bytesOf(path), flags, path);
}

cv::Mat decodedImage(const std::vector<unsigned char>& bytes, int flags, const std::string& name)
{
    if (const char* problem = problemOf(bytes))
    {
        throw InputError(name + ": " + problem);
    }
    cv::Mat image;
    try
    {
        image = cv::imdecode(bytes, flags | cv::IMREAD_IGNORE_ORIENTATION);
    }
    catch (const cv::Exception& e)
    {
        if (isOutOfMemory(e))
        {
            throw;  // says nothing about the image
        }
        throw InputError(name + ": " + e.err);
    }
    if (image.empty())
    {
        throw InputError(name + ": is not an image, or damaged");
    }
    return image;
}

namespace
{
void writeBytes(const std::string& path, const Bytes& bytes)
{
    OutputFile file(path);
    try
    {
        file.write(bytes.data(), bytes.size());
        file.commitUnsynced();
    }
    catch (const EnvironmentError&)
    {
        file.discard();
        throw;
    }
}
}  // namespace

cv::Mat readMask(const std::string& path)
{
    try
    {
        return withoutRobot(readImageFile(path, cv::IMREAD_GRAYSCALE));
    }
    catch (const std::invalid_argument& e)
    {
        throw InputError(path + ": " + e.what());
    }
}

void requireMaskSize(
    const std::string& path, cv::Size mask, cv::Size images, const std::string& label)
{
    const auto text = [](cv::Size size)
    { return std::to_string(size.width) + "x" + std::to_string(size.height); };
    if (mask != images)
    {
        throw InputError(
            path + ": is " + text(mask) + ", but images of camera '" + label + "' are " +
            text(images) + "; draw it in that size");
    }
}

void writeImageFile(const std::string& path, const cv::Mat& image, const std::vector<int>& options)
{
    Bytes bytes;
    try
    {
        if (!cv::imencode(fs::path(path).extension().string(), image, bytes, options))
        {
            throw EnvironmentError("cannot write " + path + ": the image does not fit this format");
        }
    }
    catch (const cv::Exception& e)
    {
        throw EnvironmentError(
            "cannot write " + path + ": " + (isOutOfMemory(e) ? oneLine(e) : e.err));
    }
    writeBytes(path, bytes);
}

void writeJpegFile(const std::string& path, const cv::Mat& bgr, int quality)
{
    POINTPLANE_CHECK(!bgr.empty() && bgr.type() == CV_8UC3, path << ": the image is not CV_8UC3");
    POINTPLANE_CHECK(quality >= 1 && quality <= 100, path << ": the quality is " << quality);
    writeBytes(path, jpegOf(bgr, quality));
}
}  // namespace pointplane
