// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>

namespace pointplane
{
struct TumConverterOptions
{
    std::string folder;
    std::string output;
    std::string camera;          //!< preset or file; empty: camera.txt or the folder's name
    double depthScale{0};        //!< units per metre; 0: the camera's
    double maxDifference{0.02};  //!< between the stamps of colour and depth [s]
    std::string label{"RGBD"};
    bool external{false};  //!< images as files in <output>_Images
    bool quiet{false};
};

struct TumConversion
{
    std::size_t numFrames{0};
    std::size_t numColourAlone{0};  //!< colour images without depth in time
    std::size_t numDepthAlone{0};
    double depthDelay{0};     //!< median of depth stamp minus colour stamp [s]
    std::string groundTruth;  //!< where it was copied to, or empty
};

/** Writes the folder as a rawlog: one CObservation3DRangeScan per pair of images, stamped with the
 * colour image's time, readings and pixels unchanged; before them a comment with what is known of
 * the shutters. Axes are MRPT's, sensorPose is the identity.
 * \throws InputError, EnvironmentError */
[[nodiscard]] TumConversion convertTum(const TumConverterOptions& options, std::ostream& progress);
}  // namespace pointplane
