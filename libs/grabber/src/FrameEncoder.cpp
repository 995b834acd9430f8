// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/grabber/DurableFile.h>
#include <pointplane/grabber/FrameEncoder.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/serialization/CArchive.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cstring>
#include <new>

#include <libdeflate.h>

namespace pointplane
{
namespace
{
/** An observation that refers to range and colour files instead of holding the pixels. MRPT would
 * write the files itself, but not say when the disk is full. */
class ExternalObservation : public mrpt::obs::CObservation3DRangeScan
{
 public:
    void setRangeFile(const std::string& name)
    {
        m_rangeImage_external_stored = true;
        m_rangeImage_external_file = name;
        rangeImage.resize(0, 0);
    }
};

/** MRPT's binary format of a range image, before gz. */
std::vector<std::uint8_t> rangeFileContent(const cv::Mat& depth)
{
    const std::uint32_t size[2] = {
        static_cast<std::uint32_t>(depth.rows), static_cast<std::uint32_t>(depth.cols)};
    const auto rowBytes = static_cast<std::size_t>(depth.cols) * sizeof(std::uint16_t);
    std::vector<std::uint8_t> content(sizeof(size) + rowBytes * size[0]);
    std::memcpy(content.data(), size, sizeof(size));
    for (int row = 0; row < depth.rows; ++row)
    {
        std::memcpy(
            content.data() + sizeof(size) + rowBytes * static_cast<std::size_t>(row),
            depth.ptr(row),
            rowBytes);
    }
    return content;
}

std::vector<std::uint8_t> encodeImage(const cv::Mat& bgr, int jpegQuality)
{
    std::vector<std::uint8_t> file;
    if (jpegQuality > 0)
    {
        cv::imencode(".jpg", bgr, file, {cv::IMWRITE_JPEG_QUALITY, jpegQuality});
    }
    else
    {
        // Camera noise does not repeat: Huffman alone is the smallest and the fastest.
        cv::imencode(
            ".png",
            bgr,
            file,
            {cv::IMWRITE_PNG_COMPRESSION,
             1,
             cv::IMWRITE_PNG_STRATEGY,
             cv::IMWRITE_PNG_STRATEGY_HUFFMAN_ONLY});
    }
    return file;
}

template <class Observation>
void serialise(const Observation& observation, mrpt::io::CMemoryStream& stream)
{
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive << observation;
}

mrpt::obs::CObservationComment commentOf(const std::string& text, mrpt::Clock::time_point stamp)
{
    mrpt::obs::CObservationComment out;
    out.timestamp = stamp;
    out.text = text;
    return out;
}
}  // namespace

FrameEncoder::FrameEncoder(const EncodingOptions& options, const ObservationBuilder& builder)
    : options_(options), builder_(builder)
{
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(options.jpegQuality == 0);
    if (options.jpegQuality > 0)
    {
        mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY(options.jpegQuality);
    }
    if (options.compression > 0)
    {
        compressor_ = libdeflate_alloc_compressor(options.compression);
        if (compressor_ == nullptr)
        {
            throw std::bad_alloc();
        }
    }
}

FrameEncoder::~FrameEncoder() { libdeflate_free_compressor(compressor_); }

std::vector<std::uint8_t> FrameEncoder::compressed(const void* data, std::size_t size) const
{
    if (compressor_ == nullptr)
    {
        const auto* bytes = static_cast<const std::uint8_t*>(data);
        return {bytes, bytes + size};
    }
    std::vector<std::uint8_t> out(libdeflate_gzip_compress_bound(compressor_, size));
    out.resize(libdeflate_gzip_compress(compressor_, data, size, out.data(), out.size()));
    return out;
}

std::vector<std::uint8_t> FrameEncoder::encode(
    const ImagePair& pair,
    const std::string& imagesFolder,
    std::uint64_t& externalBytes,
    const std::vector<std::string>& comments)
{
    externalBytes = 0;
    ExternalObservation observation;
    builder_.fill(pair, observation);
    if (options_.storage == ImageStorage::External)
    {
        const auto write = [&](const std::string& name, const std::vector<std::uint8_t>& content)
        {
            writeFile(imagesFolder + "/" + name, content.data(), content.size());
            externalBytes += content.size();
        };
        std::string label = observation.sensorLabel;
        std::replace(label.begin(), label.end(), '/', '_');  // no other folder
        const std::string stem = "3DCAM_" + label + "_" + numberText(pair.stamp, 6);
        const auto range = rangeFileContent(pair.depth.pixels);
        write(stem + "_RANGES.bin", compressed(range.data(), range.size()));
        observation.setRangeFile(stem + "_RANGES.bin");
        if (observation.hasIntensityImage)
        {
            const auto name = stem + (options_.jpegQuality > 0 ? "_INT.jpg" : "_INT.png");
            write(name, encodeImage(toBgr(pair.colour), options_.jpegQuality));
            observation.intensityImage.setExternalStorage(name);
        }
    }
    mrpt::io::CMemoryStream stream;
    for (const std::string& comment : comments)
    {
        serialise(commentOf(comment, observation.timestamp), stream);
    }
    serialise<mrpt::obs::CObservation3DRangeScan>(observation, stream);
    return compressed(stream.getRawBufferData(), stream.getTotalBytesCount());
}

std::vector<std::uint8_t> FrameEncoder::encode(const std::string& comment, double stamp)
{
    mrpt::io::CMemoryStream stream;
    serialise(commentOf(comment, fromSeconds(stamp)), stream);
    return compressed(stream.getRawBufferData(), stream.getTotalBytesCount());
}
}  // namespace pointplane
