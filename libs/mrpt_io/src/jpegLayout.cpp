// SPDX-License-Identifier: BSD-3-Clause
// JPEG images inside rawlogs. MRPT leaves their errors to libjpeg, which ends the process: MRPT
// gets the pixels instead.
#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include "ObjectScanner.h"
#include <turbojpeg.h>

namespace pointplane
{
using scanning::require;

namespace
{
struct Destroy
{
    void operator()(void* decoder) const { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<void, Destroy>;
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
    const Decoder decoder(tjInitDecompress());
    const std::uint8_t* const data = bytes_->data() + at;
    int jpegWidth = 0, jpegHeight = 0, subsampling = 0, colourspace = 0;
    (void)tjDecompressHeader3(
        decoder.get(), data, size, &jpegWidth, &jpegHeight, &subsampling, &colourspace);
    require(jpegWidth == width && jpegHeight == height, "a JPEG image of another size");
    std::vector<std::uint8_t> bgr(pixels * 3);
    const bool isClean =
        tjDecompress2(decoder.get(), data, size, bgr.data(), width, 0, height, TJPF_BGR, 0) == 0;
    require(isClean || tjGetErrorCode(decoder.get()) == TJERR_WARNING, "a damaged JPEG image");

    noteEdit(versionAt, 1, 1);
    noteEdit(sizeAt, bytes_->size() - sizeAt, 2 * sizeof(std::int32_t) + pixels * 3);
    // Negative sizes: pixels follow.
    const std::int32_t sizes[2] = {-width, -height};
    std::memcpy(bytes_->data() + sizeAt, sizes, sizeof(sizes));
    std::uint8_t& version = (*bytes_)[versionAt];
    version = std::max(version, kFirstVersionWithPixels);
    bytes_->resize(at - sizeof(std::uint32_t));
    bytes_->insert(bytes_->end(), bgr.begin(), bgr.end());
}
}  // namespace pointplane
