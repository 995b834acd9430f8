// SPDX-License-Identifier: BSD-3-Clause
#include "folder_layout.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** All numbers of a text file, separated by blanks or commas. */
[[nodiscard]] std::vector<double> numbersOf(const fs::path& path)
{
    std::ifstream file(path);
    if (!file || fs::is_directory(path))
    {
        throw InputError(
            "cannot open " + path.string() + ": " + (file ? "not a file" : "no such file"));
    }
    std::string text((std::istreambuf_iterator<char>(file)), {});
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream words(text);
    std::vector<double> out;
    for (std::string word; words >> word;)
    {
        const auto value = numberOf(word);
        if (!value)
        {
            throw InputError(path.string() + ": '" + word + "' is not a number");
        }
        out.push_back(*value);
    }
    return out;
}

/** A 3x3 or 4x4 matrix, row by row. Its size is not in the file: 0x0. */
[[nodiscard]] PinholeCamera cameraOfMatrix(const fs::path& path)
{
    const std::vector<double> m = numbersOf(path);
    if (m.size() != 9 && m.size() != 16)
    {
        throw InputError(path.string() + ": is not a 3x3 or 4x4 matrix");
    }
    const std::size_t columns = m.size() == 9 ? 3 : 4;
    if (m[2 * columns] != 0 || m[2 * columns + 1] != 0 || m[2 * columns + 2] != 1)
    {
        throw InputError(path.string() + ": the third row of a camera's matrix is 0 0 1");
    }
    PinholeCamera out;
    out.width = out.height = 0;
    out.fx = m[0];
    out.cx = m[2];
    out.fy = m[columns + 1];
    out.cy = m[columns + 2];
    return out;
}

[[nodiscard]] TumCamera colourCamera(const PinholeCamera& camera)
{
    TumCamera out;
    out.camera = camera;
    return out;
}

[[nodiscard]] PinholeCamera pinhole(int width, int height, double f, double cx, double cy)
{
    PinholeCamera out;
    out.width = width;
    out.height = height;
    out.fx = out.fy = f;
    out.cx = cx;
    out.cy = cy;
    return out;
}

/** ScanNet, exported from .sens: each camera with its own size, depth in the axes of colour. */
[[nodiscard]] std::optional<FolderLayout> scanNet(const fs::path& folder)
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
    out.fps = 30;
    return out;
}

/** 7-Scenes: frame-000000.color.png, frame-000000.depth.png; calibration as its authors advise. */
[[nodiscard]] std::optional<FolderLayout> sevenScenes(const fs::path& folder)
{
    FolderLayout out;
    out.name = "7-Scenes";
    out.colour = imagesIn(folder, "frame-", ".color");
    out.depth = imagesIn(folder, "frame-", ".depth");
    if (out.colour.empty() || out.depth.empty())
    {
        return {};
    }
    out.camera = colourCamera(pinhole(640, 480, 585, 320, 240));
    out.cameraIsNominal = true;
    out.fps = 30;
    return out;
}

/** Reads a JSON file's object, or nothing if it is not there. */
[[nodiscard]] std::optional<nlohmann::json> jsonOf(const fs::path& path)
{
    std::ifstream file(path);
    if (!file)
    {
        return {};
    }
    nlohmann::json out = nlohmann::json::parse(file, nullptr, false);
    if (!out.is_object())
    {
        throw InputError(path.string() + ": is not a JSON object");
    }
    return out;
}

[[nodiscard]] double valueOf(const nlohmann::json& json, const char* key, const fs::path& path)
{
    const auto found = json.find(key);
    if (found == json.end() || !found->is_number())
    {
        throw InputError(path.string() + ": has no number '" + key + "'");
    }
    return found->get<double>();
}

/** Pixels of a side. */
[[nodiscard]] int sizeOf(const nlohmann::json& json, const char* key, const fs::path& path)
{
    constexpr double kLargest = 65535;
    const double size = valueOf(json, key, path);
    if (!(size >= 1 && size <= kLargest))
    {
        throw InputError(path.string() + ": '" + key + "' is not a number of pixels");
    }
    return static_cast<int>(size);
}

/** Replica as rendered for iMAP and NICE-SLAM: results/frame000000.jpg, results/depth000000.png,
 * cam_params.json beside or above. */
[[nodiscard]] std::optional<FolderLayout> replica(const fs::path& folder)
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
        if (const auto json = jsonOf(path))
        {
            const nlohmann::json& c = json->contains("camera") ? (*json)["camera"] : *json;
            PinholeCamera camera = pinhole(
                sizeOf(c, "w", path),
                sizeOf(c, "h", path),
                valueOf(c, "fx", path),
                valueOf(c, "cx", path),
                valueOf(c, "cy", path));
            camera.fy = valueOf(c, "fy", path);
            out.camera = colourCamera(camera);
            out.unitsPerMetre = valueOf(c, "scale", path);
            break;
        }
    }
    out.fps = 30;
    return out;
}

/** Sets the stamps of images by their numbers, where `stampOf` knows them. */
template <class StampOf>
void setStamps(FolderLayout& out, const StampOf& stampOf)
{
    for (auto* images : {&out.colour, &out.depth})
    {
        for (ImageRef& image : *images)
        {
            if (const std::optional<double> stamp = stampOf(image.key))
            {
                image.stamp = stamp;
            }
        }
    }
}

/** Stamps by frame: the first two columns of StrayScanner's odometry.csv. */
[[nodiscard]] std::map<long, double> stampsOf(const fs::path& odometry)
{
    std::map<long, double> out;
    std::ifstream file(odometry);
    for (std::string line; std::getline(file, line);)
    {
        std::istringstream columns(line);
        std::string first, second;
        std::getline(columns, first, ',');
        std::getline(columns >> std::ws, second, ',');
        const auto stamp = numberOf(first), frame = numberOf(second);
        if (stamp && frame)
        {
            out[std::lround(*frame)] = *stamp;
        }
    }
    return out;
}

/** StrayScanner: rgb.mp4, depth/000000.png in millimetres, camera_matrix.csv, odometry.csv. */
[[nodiscard]] std::optional<FolderLayout> strayScanner(const fs::path& folder)
{
    if (!fs::exists(folder / "camera_matrix.csv"))
    {
        return {};
    }
    FolderLayout out;
    out.name = "StrayScanner";
    out.depth = imagesIn(folder / "depth");
    out.camera = colourCamera(cameraOfMatrix(folder / "camera_matrix.csv"));
    out.colour = imagesIn(folder / "rgb");
    if (out.colour.empty())
    {
        out.video = (folder / "rgb.mp4").string();
        out.colour = out.depth;
        std::for_each(
            out.colour.begin(), out.colour.end(), [](ImageRef& image) { image.path.clear(); });
    }
    setStamps(
        out,
        [stamps = stampsOf(folder / "odometry.csv")](long frame)
        {
            const auto found = stamps.find(frame);
            return found == stamps.end() ? std::nullopt : std::optional(found->second);
        });
    out.fps = 60;
    return out;
}

/** Record3D's metadata: K column by column, sizes of colour and depth, rate, stamps. */
void readRecord3d(const fs::path& folder, FolderLayout& out)
{
    for (const char* name : {"metadata.json", "metadata"})
    {
        const fs::path path = folder / name;
        const auto json = jsonOf(path);
        if (!json || !json->contains("K"))
        {
            continue;
        }
        const auto& K = (*json)["K"];
        if (!K.is_array() || K.size() != 9 ||
            !std::all_of(K.begin(), K.end(), [](const auto& k) { return k.is_number(); }))
        {
            throw InputError(path.string() + ": K is not a list of 9 numbers");
        }
        PinholeCamera camera = pinhole(
            sizeOf(*json, "w", path),
            sizeOf(*json, "h", path),
            K[0].get<double>(),
            K[6].get<double>(),
            K[7].get<double>());
        camera.fy = K[4].get<double>();
        out.name = "Record3D";
        out.camera = colourCamera(camera);
        if (json->contains("fps"))
        {
            out.fps = valueOf(*json, "fps", path);
            if (!(*out.fps > 0))
            {
                throw InputError(path.string() + ": 'fps' is not a positive number");
            }
        }
        if (json->contains("frameTimestamps") && (*json)["frameTimestamps"].is_array())
        {
            setStamps(
                out,
                [&stamps = (*json)["frameTimestamps"]](long frame) -> std::optional<double>
                {
                    const auto i = static_cast<std::size_t>(std::max(0L, frame));
                    return i < stamps.size() && stamps[i].is_number()
                               ? std::optional(stamps[i].get<double>())
                               : std::nullopt;
                });
        }
        return;
    }
}

/** Cameras of data sets, as published with them, by the name of the folder. */
void readPublishedCamera(const fs::path& folder, FolderLayout& out)
{
    const std::string path = fs::absolute(folder).lexically_normal().string();
    if (path.find("rgbd_bonn") != std::string::npos)
    {
        PinholeCamera camera = pinhole(640, 480, 542.822841, 315.593520, 237.756098);
        camera.fy = 542.576870;
        camera.distortion = {{0.039903, -0.099343, -0.000730, -0.000144, 0}};
        out.name = "Bonn";
        out.camera = colourCamera(camera);
        out.unitsPerMetre = 5000;
    }
}

/** Colour and depth in two folders beside each other. */
[[nodiscard]] std::optional<FolderLayout> twoFolders(const fs::path& folder)
{
    FolderLayout out;
    for (const char* name : {"rgb", "color", "colour", "image", "images", "RGB"})
    {
        if (out.colour.empty())
        {
            out.colour = imagesIn(folder / name);
        }
    }
    for (const char* name : {"depth", "depths", "Depth"})
    {
        if (out.depth.empty())
        {
            out.depth = imagesIn(folder / name);
        }
    }
    if (out.colour.empty() || out.depth.empty())
    {
        return {};
    }
    out.name = out.colour.front().stamp ? "stamped images" : "numbered images";
    const std::string first = fs::path(out.colour.front().path).stem().string();
    if (first.find('-', 1) != std::string::npos)
    {
        out.name = "Redwood";
        out.camera = colourCamera(pinhole(640, 480, 525, 319.5, 239.5));
        out.cameraIsNominal = true;
    }
    readPublishedCamera(folder, out);
    readRecord3d(folder, out);
    return out;
}
}  // namespace

FolderLayout readFolderLayout(const std::string& folder)
{
    if (!fs::is_directory(folder))
    {
        throw InputError(folder + ": is not a folder");
    }
    for (const auto reader : {scanNet, strayScanner, sevenScenes, replica, twoFolders})
    {
        if (auto layout = reader(folder))
        {
            if (layout->depth.empty() || layout->colour.empty())
            {
                throw InputError(
                    folder + ": looks like " + layout->name + ", but has no " +
                    (layout->depth.empty() ? "depth" : "colour") + " images");
            }
            return *layout;
        }
    }
    throw InputError(
        folder +
        ": not a known layout. Known are two folders like rgb and depth with numbered or stamped "
        "images, ScanNet, 7-Scenes, Redwood, Replica, Bonn, Record3D or StrayScanner");
}
}  // namespace pointplane
