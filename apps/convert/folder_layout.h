// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibration_file.h"
#include "image_names.h"

namespace pointplane
{
/** How a folder of numbered or stamped images is laid out. */
struct FolderLayout
{
    std::string name;  //!< "ScanNet", "7-Scenes", ... or "numbered images", "stamped images"
    std::vector<ImageRef> colour, depth;  //!< colour may be empty: depth alone
    std::string video;                    //!< of colour, frame by frame; `colour` then has no paths
    std::optional<Calibration> camera;    //!< of colour, where the folder tells it
    std::string calibration;              //!< file or folder that tells the cameras
    bool cameraIsNominal{false};          //!< a data set's usual camera, not this one's calibration
    std::optional<PinholeCamera> depthCamera;                         //!< where it is another
    Eigen::Isometry3d T_depth_colour{Eigen::Isometry3d::Identity()};  //!< of depthCamera
    /** Pose in the world of the camera that saw a depth image; empty: the folder tells none. */
    std::function<std::optional<Eigen::Isometry3d>(const ImageRef& depth)> poseOf;
    std::string groundTruth;  //!< of colour, a text of the TUM format, where the folder has it
    std::string aboutTruth;   //!< what people should know of poses in the folder, or empty
    double unitsPerMetre{1000};
    std::optional<double> fps;              //!< where the folder tells it
    std::string stampList;                  //!< a file that tells stamps by number, if there is one
    std::vector<std::string> otherSources;  //!< of images, that could have been meant, too
};

/** \throws InputError if there are no depth images in a layout that is known, or beside them images
 * that are not known as colour */
[[nodiscard]] FolderLayout readFolderLayout(const std::string& folder);
}  // namespace pointplane
