// SPDX-License-Identifier: BSD-3-Clause
// JPEG images inside rawlogs. MRPT leaves their errors to libjpeg, which ends the process: MRPT
// gets the pixels instead.
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cstring>

#include "ObjectScanner.h"

namespace pointplane
{
using scanning::require;

namespace
{
/** Size of a JPEG image by its frame header, or 0x0: a decoder allocates what it says. */
cv::Size jpegSize(const std::uint8_t* data, std::size_t size)
{
    const auto word = [data](std::size_t at) { return data[at] * 256 + data[at + 1]; };
    std::size_t at = 2;  // after the start marker
    while (at + 9 <= size && data[at] == 0xFF)
    {
        const int marker = data[at + 1];
        const bool isFrame =
            marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
        if (isFrame)
        {
            return {word(at + 7), word(at + 5)};
        }
        at += 2 + static_cast<std::size_t>(word(at + 2));
    }
    return {};
}

cv::Mat decoded(std::uint8_t* data, std::size_t size)
{
    try
    {
        const cv::Mat jpeg(1, static_cast<int>(size), CV_8UC1, data);
        return cv::imdecode(jpeg, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
    }
    catch (const cv::Exception&)
    {
        return {};
    }
}
}  // namespace

void ObjectScanner::jpegPixels(std::size_t versionAt, std::int32_t width, std::int32_t height)
{
    constexpr std::uint8_t kFirstVersionWithPixels = 8;
    const std::uint64_t pixels =
        scanning::numPixels(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
    const std::size_t sizeAt = bytes_->size() - 2 * sizeof(std::int32_t);
    const auto size = copyValue<std::uint32_t>();
    require(size <= pixels * 6 + 65536, "a JPEG image larger than its pixels");
    const std::size_t at = bytes_->size();
    copy(size);
    const cv::Size expected(width, height);
    require(jpegSize(bytes_->data() + at, size) == expected, "a JPEG image of another size");
    const cv::Mat image = decoded(bytes_->data() + at, size);
    require(image.type() == CV_8UC3 && image.size() == expected, "a damaged JPEG image");

    noteEdit(versionAt, 1, 1);
    noteEdit(sizeAt, bytes_->size() - sizeAt, 2 * sizeof(std::int32_t) + pixels * 3);
    // Negative sizes: pixels follow.
    const std::int32_t sizes[2] = {-width, -height};
    std::memcpy(bytes_->data() + sizeAt, sizes, sizeof(sizes));
    std::uint8_t& version = (*bytes_)[versionAt];
    version = std::max(version, kFirstVersionWithPixels);
    bytes_->resize(at - sizeof(std::uint32_t));
    const cv::Mat whole = image.isContinuous() ? image : image.clone();
    bytes_->insert(bytes_->end(), whole.data, whole.data + pixels * 3);
}
}  // namespace pointplane
