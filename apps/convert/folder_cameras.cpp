// SPDX-License-Identifier: BSD-3-Clause
#include "folder_cameras.h"

#include <cmath>
#include <cstdint>

#include "frame_images.h"

namespace pointplane
{
namespace
{
void checkCamera(const PinholeCamera& camera, const std::string& file, const char* which)
{
    const std::string problem = camera.problem();
    if (!problem.empty())
    {
        throw BadFrame(file + ": calibration of the " + which + " camera: " + problem);
    }
}
}  // namespace

void setCameras(RegisteredScan& scan, const FolderLayout& layout, const std::string& name)
{
    scan.camera = layout.camera->camera;
    if (scan.camera.width == 0)  // of a matrix without a size
    {
        scan.camera.width = scan.colour.cols;
        scan.camera.height = scan.colour.rows;
    }
    checkCamera(scan.camera, layout.calibration, "colour");
    // A calibration for another size of the same picture.
    if (scan.colour.cols != scan.camera.width &&
        std::int64_t{scan.colour.cols} * scan.camera.height ==
            std::int64_t{scan.colour.rows} * scan.camera.width)
    {
        scan.camera = scan.camera.scaled(static_cast<double>(scan.colour.cols) / scan.camera.width);
        // A principal point at the border of one size can be outside of another.
        checkCamera(scan.camera, layout.calibration, "colour");
    }
    if (scan.colour.cols != scan.camera.width || scan.colour.rows != scan.camera.height)
    {
        throw BadFrame(
            name + ": is " + sizeText(scan.colour.size()) + ", but the camera is for " +
            sizeText({scan.camera.width, scan.camera.height}));
    }
    if (layout.depthCamera)
    {
        scan.depthCamera = DepthCamera{*layout.depthCamera, layout.T_depth_colour};
        scan.depthCamera->camera.width = scan.depth.cols;
        scan.depthCamera->camera.height = scan.depth.rows;
        checkCamera(scan.depthCamera->camera, layout.calibration, "depth");
    }
    else if (scan.depth.size() != scan.colour.size())
    {
        const PinholeCamera scaled =
            scan.camera.scaled(static_cast<double>(scan.depth.cols) / scan.camera.width);
        if (std::abs(scaled.height - scan.depth.rows) > 1)
        {
            throw BadFrame(
                name + ": depth is " + sizeText(scan.depth.size()) + " and colour " +
                sizeText(scan.colour.size()) + ", which are different views");
        }
        scan.depthCamera = DepthCamera{scaled, Eigen::Isometry3d::Identity()};
        scan.depthCamera->camera.distortion = {};
        scan.depthCamera->camera.height = scan.depth.rows;
        checkCamera(scan.depthCamera->camera, layout.calibration, "depth");
    }
}
}  // namespace pointplane
