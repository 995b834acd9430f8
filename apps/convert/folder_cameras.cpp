// SPDX-License-Identifier: BSD-3-Clause
#include "folder_cameras.h"

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

/** Fits the calibration to the size of an image. \param name of the image \throws BadFrame if it is
 * of another view */
void fitCamera(
    PinholeCamera& camera,
    const cv::Size& size,
    const FolderLayout& layout,
    const std::string& name,
    const char* which)
{
    if (camera.width == 0)  // of a matrix without a size
    {
        camera.width = size.width;
        camera.height = size.height;
    }
    checkCamera(camera, layout.calibration, which);
    // A calibration for another size of the same picture.
    if (size.width != camera.width &&
        std::int64_t{size.width} * camera.height == std::int64_t{size.height} * camera.width)
    {
        camera = camera.scaled(static_cast<double>(size.width) / camera.width);
        // A principal point at the border of one size can be outside of another.
        checkCamera(camera, layout.calibration, which);
    }
    if (size.width != camera.width || size.height != camera.height)
    {
        throw BadFrame(
            name + ": is " + sizeText(size) + ", but the camera is for " +
            sizeText({camera.width, camera.height}));
    }
}
}  // namespace

void setCameras(RegisteredScan& scan, const FolderLayout& layout, const std::string& name)
{
    scan.camera = layout.camera->camera;
    if (scan.colour.empty())
    {
        fitCamera(scan.camera, scan.depth.size(), layout, name, "depth");
        return;
    }
    fitCamera(scan.camera, scan.colour.size(), layout, name, "colour");
    if (layout.depthCamera)
    {
        scan.depthCamera = DepthCamera{*layout.depthCamera, layout.T_depth_colour};
        scan.depthCamera->camera.width = scan.depth.cols;
        scan.depthCamera->camera.height = scan.depth.rows;
        checkCamera(scan.depthCamera->camera, layout.calibration, "depth");
    }
    else if (scan.depth.size() != scan.colour.size())
    {
        setCameraOfRegisteredDepth(scan, name + ": ");
        checkCamera(scan.depthCamera->camera, layout.calibration, "depth");
    }
}
}  // namespace pointplane
