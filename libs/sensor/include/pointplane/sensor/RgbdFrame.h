// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/PinholeCamera.h>

#include <opencv2/core/mat.hpp>

#include <cmath>
#include <limits>

namespace pointplane
{
/** When pixels of both images are exposed: at stamp + delay + f readout with f = readoutFraction(),
 * which is v / height - 1/2 in row v unless images are upright. delay = 0 for colour. NaN = not
 * known. */
struct ShutterModel
{
    static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    double readoutColour{kUnknown};  //!< first to last row of the colour image [s]; 0 = global
    double readoutDepth{kUnknown};   //!< first to last row of the depth image [s]
    double depthDelay{kUnknown};     //!< middle of the depth exposure minus middle of colour's [s]

    /** No camera takes longer than a second. */
    [[nodiscard]] bool isPlausible() const
    {
        const auto isLong = [](double seconds) { return std::abs(seconds) > 1; };  // NaN is not
        return !isLong(readoutColour) && !isLong(readoutDepth) && !isLong(depthDelay);
    }
};

/** One registered RGB-D image. The pose of a frame is the camera's at `stamp`, the middle of the
 * colour exposure. */
struct RgbdFrame
{
    double stamp{0};       //!< [s] UTC
    cv::Mat gray;          //!< CV_8UC1, height x width; empty when there is no intensity image
    cv::Mat depth;         //!< CV_32FC1, same size, [m] along the optical axis, NaN = no reading
    PinholeCamera camera;  //!< of both images
    ShutterModel shutter;  //!< as far as the source knows it
};

/** Fewer readings are none, as a fraction of the image: there is no plane, and hardly a point. */
constexpr double kLeastDepthShare = 0.01;

/** Whether the depth image has readings: in kLeastDepthShare of its pixels at least. */
[[nodiscard]] bool hasDepth(const RgbdFrame& frame);
}  // namespace pointplane
