// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <limits>

namespace pointplane
{
enum class StreamKind
{
    Depth,
    Colour
};

enum class PixelLayout
{
    Depth16,  //!< CV_16UC1, 0 = no reading, in CameraImage::depthUnit
    Rgb8,     //!< CV_8UC3
    Gray8,    //!< CV_8UC1
    Yuyv,     //!< CV_8UC2
    Uyvy      //!< CV_8UC2
};

/** One image of one stream, as the camera delivered it. Copies share the pixels. */
struct CameraImage
{
    StreamKind stream{StreamKind::Depth};
    PixelLayout layout{PixelLayout::Depth16};
    std::int64_t index{0};    //!< the driver's own count; a gap is a lost frame
    double deviceTime{0};     //!< [s] of the camera's clock, arbitrary zero, same for both streams
    bool hasClock{true};      //!< false: the stamps follow none, deviceTime is that of arrival
    double arrival{0};        //!< [s] UTC when the host had it; never steps back
    double depthUnit{0.001};  //!< [m] per count
    cv::Mat pixels;
};

/** A depth and a colour image that were taken together. */
struct ImagePair
{
    CameraImage depth;
    CameraImage colour;  //!< without pixels when the camera has no colour
    double stamp{0};     //!< [s] UTC, of the colour image if there is one

    /** By the camera's own clock [s]; NaN without colour or clock. */
    [[nodiscard]] double depthDelay() const
    {
        return colour.pixels.empty() || !colour.hasClock ? std::numeric_limits<double>::quiet_NaN()
                                                         : depth.deviceTime - colour.deviceTime;
    }
};
}  // namespace pointplane
