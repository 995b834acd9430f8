// SPDX-License-Identifier: BSD-3-Clause
#include "folder_cameras.h"

#include <algorithm>
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

/** \throws BadFrame if a matrix without a size seems to be for a larger or smaller picture */
void checkMatrixOf(
    const PinholeCamera& camera,
    const cv::Size& size,
    const std::string& file,
    const std::string& name)
{
    // Principal points of real cameras are nearer to the middle, in one direction at least.
    constexpr double kMost = 0.1;  // of half the image
    const double across = 2 * camera.cx / size.width - 1, down = 2 * camera.cy / size.height - 1;
    if (across * down > 0 && std::min(std::abs(across), std::abs(down)) > kMost)
    {
        throw BadFrame(
            name + ": is " + sizeText(size) + ", but the matrix in " + file +
            " seems to be of images of about " +
            sizeText(
                {static_cast<int>(std::lround(2 * camera.cx)),
                 static_cast<int>(std::lround(2 * camera.cy))}) +
            "; give a calibration for this size by --camera");
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
        checkMatrixOf(camera, size, layout.calibration, name);
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
