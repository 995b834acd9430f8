// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/ScanWriter.h>

#include <optional>
#include <string>
#include <vector>

#include "BagRecording.h"
#include "bag_topics.h"

namespace pointplane
{
/** The two cameras of a bag. */
struct BagCameras
{
    PinholeCamera colour;
    std::optional<DepthCamera> depth;  //!< where depth is not registered
    double unitsPerMetre{1000};        //!< of 16 bit depth
    std::vector<std::string> notes;    //!< what had to be assumed; some are empty
};

/** From CameraInfo, static transforms and what RealSense's recorder writes beside the images.
 * \throws InputError where the bag does not tell what the options do not */
[[nodiscard]] BagCameras readBagCameras(
    const rosbag::Bag& bag,
    const ImageTopic& colour,
    const ImageTopic& depth,
    const BagOptions& options);
}  // namespace pointplane
