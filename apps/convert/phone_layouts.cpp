// SPDX-License-Identifier: BSD-3-Clause
#include "phone_layouts.h"

#include <pointplane/core/number_text.h>
#include <pointplane/core/read_errors.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "layout_files.h"
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

/** Stamps by frame: the first two columns of StrayScanner's odometry.csv. */
[[nodiscard]] std::map<long, double> stampsOf(const fs::path& odometry)
{
    std::map<long, double> out;
    std::ifstream file(odometry);
    for (std::string line; std::getline(file, line);)
    {
        std::istringstream columns(line);
        std::string first, second;
        std::getline(columns >> std::ws, first, ',');
        std::getline(columns >> std::ws, second, ',');
        const auto stamp = parseFinite(first), frame = parseFinite(second);
        if (stamp && frame)
        {
            out[std::lround(*frame)] = *stamp;
        }
    }
    requireRead(file, odometry.string());
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
        setStamps(
            out,
            list,
            [stamps = stampsOf(list)](long frame)
            {
                const auto found = stamps.find(frame);
                return found == stamps.end() ? std::nullopt : std::optional(found->second);
            });
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
        return;
    }
}
}  // namespace pointplane
