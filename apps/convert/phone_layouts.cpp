// SPDX-License-Identifier: BSD-3-Clause
#include "phone_layouts.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "layout_files.h"
#include "pose_numbers.h"
#include "stray_odometry.h"
#include <nlohmann/json.hpp>

namespace pointplane
{
namespace fs = std::filesystem;

namespace
{
/** Sets the stamps of images by their numbers, where `stampOf` knows them. \param list its file */
template <class StampOf>
void setStamps(FolderLayout& out, const fs::path& list, const StampOf& stampOf)
{
    out.stampList = list.string();
    for (auto* images : {&out.colour, &out.depth})
    {
        for (ImageRef& image : *images)
        {
            const std::optional<double> stamp = stampOf(image.key);
            if (image.isNumbered && stamp)
            {
                image.stamp = stamp;
            }
        }
    }
}

/** ARKit's poses of frames. A place that is exactly zero in several frames was not measured. */
void setPoses(FolderLayout& out, NumberedPoses poses)
{
    const auto isZero = [](const auto& numbered)
    { return numbered.second.translation().isZero(0); };
    if (std::count_if(poses.begin(), poses.end(), isZero) > 1)
    {
        for (auto it = poses.begin(); it != poses.end();)
        {
            it = isZero(*it) ? poses.erase(it) : std::next(it);
        }
    }
    out.poseOf = poseByNumber(std::move(poses));
}

/** Record3D's "poses", [qx, qy, qz, qw, x, y, z] of each frame, or null. Its camera has OpenGL's
 * axes, x right, y up, z backward. */
[[nodiscard]] NumberedPoses posesOfRecord3d(const nlohmann::json& json, const fs::path& path)
{
    constexpr std::size_t kNumbers = 7;
    const Eigen::Isometry3d T_opengl_optical(Eigen::Quaterniond(0, 1, 0, 0));
    if (!json.is_array())
    {
        throw InputError(path.string() + ": 'poses' is not a list");
    }
    NumberedPoses out;
    for (std::size_t i = 0; i < json.size(); ++i)
    {
        const nlohmann::json& v = json[i];
        if (v.is_null())
        {
            continue;
        }
        if (!v.is_array() || v.size() != kNumbers ||
            !std::all_of(v.begin(), v.end(), [](const auto& x) { return x.is_number(); }))
        {
            throw InputError(
                path.string() + ": the pose of frame " + std::to_string(i) +
                " is not a list of 7 numbers");
        }
        const auto numbers = v.get<std::vector<double>>();
        const auto pose =
            poseFromQuaternion(Eigen::Vector3d(&numbers[4]), Eigen::Vector4d(&numbers[0]));
        if (pose)
        {
            out.emplace(static_cast<long>(i), *pose * T_opengl_optical);
        }
    }
    return out;
}
}  // namespace

std::optional<FolderLayout> strayScanner(const fs::path& folder)
{
    if (!fs::exists(folder / "camera_matrix.csv"))
    {
        return {};
    }
    FolderLayout out;
    out.name = "StrayScanner";
    out.depth = imagesIn(folder / "depth");
    out.calibration = (folder / "camera_matrix.csv").string();
    out.camera = colourCamera(cameraOfMatrix(out.calibration));
    out.colour = imagesIn(folder / "rgb");
    const std::string video = (folder / "rgb.mp4").string();
    if (!out.colour.empty() && fs::exists(video))
    {
        out.otherSources.push_back(video);
    }
    if (out.colour.empty())
    {
        out.video = video;
        out.colour = out.depth;
        std::for_each(
            out.colour.begin(), out.colour.end(), [](ImageRef& image) { image.path.clear(); });
    }
    if (const fs::path list = folder / "odometry.csv"; fs::exists(list))
    {
        StrayOdometry odometry = readStrayOdometry(list);
        setStamps(
            out,
            list,
            [&stamps = odometry.stamps](long frame)
            {
                const auto found = stamps.find(frame);
                return found == stamps.end() ? std::nullopt : std::optional(found->second);
            });
        setPoses(out, std::move(odometry.poses));
    }
    out.fps = 60;
    return out;
}

void readRecord3d(const fs::path& folder, FolderLayout& out)
{
    for (const char* name : {"metadata.json", "metadata"})
    {
        const fs::path path = folder / name;
        const auto json = jsonObjectIn(path);
        if (!json || !json->contains("K"))
        {
            continue;
        }
        out.name = "Record3D";
        out.calibration = path.string();
        out.camera = colourCamera(cameraAt(*json, {"K", "w", "h"}, path));
        out.fps = rateIn(*json, path);
        if (json->contains("frameTimestamps") && (*json)["frameTimestamps"].is_array())
        {
            setStamps(
                out,
                path,
                [&stamps = (*json)["frameTimestamps"]](long frame) -> std::optional<double>
                {
                    const auto i = static_cast<std::size_t>(std::max(0L, frame));
                    return i < stamps.size() && stamps[i].is_number()
                               ? std::optional(stamps[i].get<double>())
                               : std::nullopt;
                });
        }
        if (json->contains("poses"))
        {
            setPoses(out, posesOfRecord3d((*json)["poses"], path));
        }
        return;
    }
}
}  // namespace pointplane
