// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "Recording.h"

namespace pointplane
{
struct BagOptions
{
    std::string file;
    std::string colourTopic, depthTopic;  //!< empty: the only ones, or the usual ones
    std::string camera;                   //!< file; empty: CameraInfo of the bag
    double depthScale{0};                 //!< units per metre of 16 bit depth; 0: the encoding's
    double maxDifference{0.02};           //!< between the stamps of colour and depth [s]
};

/** A ROS 1 bag with sensor_msgs/Image or CompressedImage of colour and depth, CameraInfo, and,
 * where depth is not registered, static transforms between the two cameras' frames. \throws
 * InputError; EnvironmentError where this program was built without bags */
[[nodiscard]] std::unique_ptr<Recording> openBag(const BagOptions& options);
}  // namespace pointplane
