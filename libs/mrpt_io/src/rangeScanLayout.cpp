// SPDX-License-Identifier: BSD-3-Clause
// The layouts of CObservation3DRangeScan and what it is made of, as MRPT serialises them.
#include <cstring>
#include <iterator>

#include "ObjectScanner.h"

namespace pointplane
{
using scanning::numPixels;
using scanning::require;
using scanning::requireKnown;

void ObjectScanner::range3DScan(int version)
{
    copy(sizeof(float));  // maxRange
    copyObject("CPose3D");
    if (copyBool())  // points, and their pixels
    {
        copyArray(copyValue<std::uint32_t>(), 3 * sizeof(float) + 2 * sizeof(std::uint16_t));
    }
    rangeImage();
    copy(sizeof(float) + sizeof(std::uint64_t));  // stdError, time stamp
    copyString();
    copyBool();  // external points and their file
    copyString();
    copyBool();  // external ranges and their file
    copyString();
    copyBool();                 // range_is_depth
    copy(sizeof(std::int8_t));  // intensity channel
    if (copyBool())
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

void ObjectScanner::rangeImage()
{
    Resolution range;
    const bool hasRange = copyBool();
    copy(sizeof(float));  // rangeUnits
    if (hasRange)
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
    copyObject("TCamera");
    exchangeResolution(range);
    copyObject("TCamera");
    copyObject("CPose3D");
}

void ObjectScanner::exchangeResolution(const Resolution& range)
{
    std::uint32_t size[2];  // rows, columns
    std::uint8_t* at = bytes_->data() + cameraResolutionAt_;
    std::memcpy(size, at, sizeof(size));
    resolutions_.push_back({size[0], size[1]});
    if (range.rows > 0 && range.cols > 0)
    {
        noteEdit(cameraResolutionAt_, sizeof(size), sizeof(size));
        size[0] = range.rows;
        size[1] = range.cols;
        std::memcpy(at, size, sizeof(size));
    }
}

void ObjectScanner::pixelLabels()
{
    requireKnown(copyValue<std::uint8_t>() == 1, "pixel labels of another version");
    const auto bytesPerPixel = copyValue<std::uint8_t>();
    require(bytesPerPixel >= 1 && bytesPerPixel <= 8, "pixel labels of an unknown size");
    const auto rows = copyValue<std::uint32_t>();
    copyArray(numPixels(copyValue<std::uint32_t>(), rows), bytesPerPixel);
    copyString();  // "std::map" and the names of its types
    copyString();
    copyString();
    const auto numNames = copyValue<std::uint32_t>();
    require(numNames <= 8U * bytesPerPixel, "more pixel labels than there are bits");
    for (std::uint32_t i = 0; i < numNames; ++i)
    {
        copy(sizeof(std::uint32_t));
        copyString();
    }
}

void ObjectScanner::image(int version)
{
    requireKnown(
        version >= 7 && version <= 9,
        "an image of serialisation version " + std::to_string(version) + " (7 to 9 are supported)");
    const std::size_t versionAt = bytes_->size() - 1;
    if (copyBool())
    {
        copyString();  // external file
        return;
    }
    if (copyBool())
    {
        colourPixels(versionAt, version);
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

void ObjectScanner::colourPixels(std::size_t versionAt, int version)
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
        jpegPixels(versionAt, width, height);
    }
}

void ObjectScanner::camera(int version)
{
    requireKnown(
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
    requireKnown(
        version == 2 || version == 3,
        "a pose of serialisation version " + std::to_string(version) + " (2, 3 are supported)");
    // Translation and rotation matrix; a quaternion in version 2.
    copyArray(version == 3 ? 12 : 7, sizeof(double));
}

}  // namespace pointplane
