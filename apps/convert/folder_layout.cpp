// SPDX-License-Identifier: BSD-3-Clause
#include "folder_layout.h"

#include <pointplane/mrpt_io/errors.h>

#include <filesystem>

#include "dataset_layouts.h"
#include "layout_files.h"
#include "phone_layouts.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

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
