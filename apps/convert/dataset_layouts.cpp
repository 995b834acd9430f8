// SPDX-License-Identifier: BSD-3-Clause
#include "dataset_layouts.h"

#include <pointplane/core/se3.h>

#include <string>

#include "layout_files.h"
#include <nlohmann/json.hpp>

namespace pointplane
{
namespace fs = std::filesystem;

namespace
{
/** Of a camera in a common base; identity if the folder does not tell. */
[[nodiscard]] Eigen::Isometry3d extrinsicIn(const fs::path& path)
{
    return fs::exists(path) ? poseOfMatrix(path) : Eigen::Isometry3d::Identity();
}
}  // namespace

std::optional<FolderLayout> scanNet(const fs::path& folder)
{
    const fs::path intrinsic = folder / "intrinsic";
    if (!fs::exists(intrinsic / "intrinsic_depth.txt"))
    {
        return {};
    }
    FolderLayout out;
    out.name = "ScanNet";
    out.colour = imagesIn(folder / "color");
    out.depth = imagesIn(folder / "depth");
    out.camera = colourCamera(cameraOfMatrix(intrinsic / "intrinsic_color.txt"));
    out.depthCamera = cameraOfMatrix(intrinsic / "intrinsic_depth.txt");
    out.T_depth_colour = extrinsicIn(intrinsic / "extrinsic_depth.txt").inverse() *
                         extrinsicIn(intrinsic / "extrinsic_color.txt");
    out.calibration = intrinsic.string();
    if (fs::is_directory(folder / "pose"))
    {
        out.poseOf = [folder](const ImageRef& depth)
        { return poseIn(folder / "pose" / fs::path(depth.path).stem().concat(".txt")); };
    }
    out.fps = 30;
    return out;
}

std::optional<FolderLayout> sevenScenes(const fs::path& folder)
{
    FolderLayout out;
    out.name = "7-Scenes";
    out.colour = imagesIn(folder, "frame-", ".color");
    out.depth = imagesIn(folder, "frame-", ".depth");
    if (out.colour.empty() || out.depth.empty())
    {
        return {};
    }
    // The images are those of an uncalibrated Kinect. The data set names 585 px for depth; 525 px
    // and the place are what its users take: LIRIS' calibration of another Kinect.
    out.camera = colourCamera(pinholeOf(640, 480, 525, 320, 240));
    out.depthCamera = pinholeOf(640, 480, 585, 320, 240);
    Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
    T_colour_depth.linear() = so3Exp({0.00816, -0.00789, -0.00271});
    T_colour_depth.translation() << -0.02556, 0.0001, 0.00203;
    out.T_depth_colour = T_colour_depth.inverse();
    out.cameraIsNominal = true;
    const auto poseFile = [](const ImageRef& depth)  // "frame-000000.pose.txt"
    { return fs::path(depth.path).replace_extension().replace_extension(".pose.txt"); };
    if (fs::exists(poseFile(out.depth.front())))
    {
        out.poseOf = [poseFile](const ImageRef& depth) { return poseIn(poseFile(depth)); };
    }
    out.fps = 30;
    return out;
}

std::optional<FolderLayout> replica(const fs::path& folder)
{
    const fs::path results = fs::is_directory(folder / "results") ? folder / "results" : folder;
    FolderLayout out;
    out.name = "Replica";
    out.colour = imagesIn(results, "frame");
    out.depth = imagesIn(results, "depth");
    if (out.colour.empty() || out.depth.empty())
    {
        return {};
    }
    for (const fs::path& path : {folder / "cam_params.json", folder / ".." / "cam_params.json"})
    {
        if (const auto json = jsonObjectIn(path))
        {
            const nlohmann::json& c = json->contains("camera") ? (*json)["camera"] : *json;
            PinholeCamera camera = pinholeOf(
                pixelsIn(c, "w", path),
                pixelsIn(c, "h", path),
                numberAt(c, "fx", path),
                numberAt(c, "cx", path),
                numberAt(c, "cy", path));
            camera.fy = numberAt(c, "fy", path);
            out.camera = colourCamera(camera);
            out.calibration = path.string();
            out.unitsPerMetre = numberAt(c, "scale", path);
            break;
        }
    }
    if (fs::exists(folder / "traj.txt"))
    {
        out.poseOf = [poses = posesInLines(folder / "traj.txt")](const ImageRef& depth)
        {
            const auto line = static_cast<std::size_t>(depth.key);
            return line < poses.size() ? poses[line] : std::nullopt;
        };
    }
    out.fps = 30;
    return out;
}

void readPublishedCamera(const fs::path& folder, FolderLayout& out)
{
    if (isInNameOf(folder, "rgbd_bonn"))
    {
        PinholeCamera camera = pinholeOf(640, 480, 542.822841, 315.593520, 237.756098);
        camera.fy = 542.576870;
        camera.distortion = {{0.039903, -0.099343, -0.000730, -0.000144, 0}};
        out.name = "Bonn";
        out.camera = colourCamera(camera);
        out.unitsPerMetre = 5000;
    }
}

void readOpen3d(const fs::path& folder, FolderLayout& out)
{
    for (const char* name : {"intrinsic.json", "camera_intrinsic.json"})
    {
        const fs::path path = folder / name;
        const auto json = jsonIn(path);  // other programs have files of this name
        if (const auto camera = json ? open3dCamera(*json, path) : std::nullopt)
        {
            out.name = "Open3D";
            out.camera = camera;
            out.cameraIsNominal = false;
            out.calibration = path.string();
            out.unitsPerMetre = camera->tellsUnits ? camera->unitsPerMetre : out.unitsPerMetre;
            out.fps = rateIn(*json, path);
            return;
        }
    }
}
}  // namespace pointplane
