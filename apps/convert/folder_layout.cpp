// SPDX-License-Identifier: BSD-3-Clause
#include "folder_layout.h"

#include <pointplane/mrpt_io/errors.h>

#include <filesystem>
#include <initializer_list>

#include "dataset_layouts.h"
#include "layout_files.h"
#include "phone_layouts.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** The images of the first of these folders that has any. \param others of them that have some */
[[nodiscard]] std::vector<ImageRef> imagesInFirst(
    const fs::path& folder,
    std::initializer_list<const char*> names,
    std::vector<std::string>& others)
{
    std::vector<ImageRef> out;
    for (const char* name : names)
    {
        const fs::path candidate = folder / name;
        if (out.empty())
        {
            out = imagesIn(candidate);
        }
        else if (
            !imagesIn(candidate).empty() &&
            !fs::equivalent(candidate, fs::path(out.front().path).parent_path()))
        {
            others.push_back(candidate.string());
        }
    }
    return out;
}

/** Colour and depth in two folders beside each other. */
[[nodiscard]] std::optional<FolderLayout> twoFolders(const fs::path& folder)
{
    FolderLayout out;
    out.colour = imagesInFirst(
        folder, {"rgb", "color", "colour", "image", "images", "RGB"}, out.otherSources);
    out.depth = imagesInFirst(folder, {"depth", "depths", "Depth"}, out.otherSources);
    if (out.colour.empty() || out.depth.empty())
    {
        return {};
    }
    out.name = out.colour.front().stamp ? "stamped images" : "numbered images";
    const std::string first = fs::path(out.colour.front().path).stem().string();
    if (first.find('-', 1) != std::string::npos)
    {
        out.name = "Redwood";
        out.camera = colourCamera(pinholeOf(640, 480, 525, 319.5, 239.5));
        out.cameraIsNominal = true;
    }
    readPublishedCamera(folder, out);
    readRecord3d(folder, out);
    return out;
}
}  // namespace

FolderLayout readFolderLayout(const std::string& folder)
{
    requireFolder(folder);
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
        ": not a known layout. Known are ScanNet, 7-Scenes, Redwood, Replica, Bonn, Record3D, "
        "StrayScanner, and two folders, rgb (or color, colour, image, images) and depth (depths), "
        "whose images are named by number or stamp alone, as 12.png or 1500000000.25.png");
}
}  // namespace pointplane
