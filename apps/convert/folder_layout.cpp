// SPDX-License-Identifier: BSD-3-Clause
#include "folder_layout.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include "dataset_layouts.h"
#include "layout_files.h"
#include "phone_layouts.h"
#include "trajectory_log.h"
#include "tum_truth.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** What images and folders of one kind are called. */
using Words = std::vector<std::string>;

const Words kColourWords{"rgb", "color", "colour", "image", "images", "RGB"};
const Words kDepthWords{"depth", "depths", "Depth"};
const Words kWordsOfBoth{"image", "img", "frame"};  //!< in folders of one kind

/** Images named by a word and a number or stamp, in either order, like rgb_12.png. */
[[nodiscard]] std::vector<ImageRef> imagesWithWord(const fs::path& folder, const Words& words)
{
    for (const std::string& word : words)
    {
        for (const char* between : {"_", "-", ".", " ", ""})
        {
            auto out = imagesIn(folder, word + between);
            if (out.empty())
            {
                out = imagesIn(folder, "", between + word);
            }
            if (!out.empty())
            {
                return out;
            }
        }
    }
    return {};
}

/** Images of a folder of one kind: named by a number or stamp, else with a word beside it. */
[[nodiscard]] std::vector<ImageRef> imagesOf(const fs::path& folder, const Words& words)
{
    auto out = imagesIn(folder);
    for (const Words* more : {&words, &kWordsOfBoth})
    {
        out = out.empty() ? imagesWithWord(folder, *more) : out;
    }
    return out;
}

/** The images of the first of the folders with these names that has any. \param others of them that
 * have some */
[[nodiscard]] std::vector<ImageRef> imagesInFirst(
    const fs::path& folder, const Words& names, std::vector<std::string>& others)
{
    std::vector<ImageRef> out;
    for (const std::string& name : names)
    {
        const fs::path candidate = folder / name;
        if (out.empty())
        {
            out = imagesOf(candidate, names);
        }
        else if (
            !imagesOf(candidate, names).empty() &&
            !fs::equivalent(candidate, fs::path(out.front().path).parent_path()))
        {
            others.push_back(candidate.string());
        }
    }
    return out;
}

/** Images of the folder and those in it, but for `depth` and what is in folders of depth. */
[[nodiscard]] std::vector<std::string> imagesBut(
    const fs::path& folder, const std::vector<ImageRef>& depth)
{
    std::set<std::string> known;
    for (const ImageRef& image : depth)
    {
        known.insert(image.path);
    }
    std::vector<std::string> out;
    for (const std::string& path : imagesInFolder(folder))
    {
        if (known.count(path) == 0)
        {
            out.push_back(path);
        }
    }
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
    {
        const std::string name = entry.path().filename();
        const bool isOfDepth =
            std::find(kDepthWords.begin(), kDepthWords.end(), name) != kDepthWords.end();
        if (entry.is_directory(error) && (depth.empty() || !isOfDepth))
        {
            const auto inside = imagesInFolder(entry.path());
            out.insert(out.end(), inside.begin(), inside.end());
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

/** By names alone: a link is told, not where it leads. */
[[nodiscard]] std::string relativeTo(const fs::path& folder, const fs::path& path)
{
    return path.lexically_relative(folder).string();
}

/** Depth may be alone only if nothing else can be colour. */
void requireNoOthers(const fs::path& folder, const std::vector<ImageRef>& depth)
{
    if (const auto others = imagesBut(folder, depth); !others.empty())
    {
        throw InputError(
            folder.string() + ": has depth, but its other images are not known as colour: " +
            relativeTo(folder, others.front()) +
            "; name their folder rgb and them by numbers, or move them away");
    }
}

/** By stamps or numbers, as the images have them. */
void readTruth(const fs::path& folder, FolderLayout& out)
{
    if (!out.depth.front().isNumbered)
    {
        TumTruth truth = readTumTruth(folder.string());
        out.groundTruth = std::move(truth.text);
        out.aboutTruth = std::move(truth.note);
    }
    else if (!out.poseOf)
    {
        readTrajectoryIn(folder, out);
    }
}

/** Colour and depth in two folders beside each other, or in one, told by a word in the names; or
 * depth alone. */
[[nodiscard]] std::optional<FolderLayout> oneOrTwoFolders(const fs::path& folder)
{
    FolderLayout out;
    out.colour = imagesInFirst(folder, kColourWords, out.otherSources);
    out.depth = imagesInFirst(folder, kDepthWords, out.otherSources);
    if (out.colour.empty() && out.depth.empty())
    {
        out.colour = imagesWithWord(folder, kColourWords);
        out.depth = imagesWithWord(folder, kDepthWords);
    }
    if (out.depth.empty())
    {
        return {};
    }
    if (out.colour.empty())
    {
        requireNoOthers(folder, out.depth);
    }
    const ImageRef& first = out.colour.empty() ? out.depth.front() : out.colour.front();
    out.name = first.stamp ? "stamped images" : "numbered images";
    if (first.stamp && first.isNumbered)
    {
        out.name = "Redwood";
        out.camera = colourCamera(pinholeOf(640, 480, 525, 319.5, 239.5));
        out.cameraIsNominal = true;
    }
    if (fs::exists(folder / "rgb.txt") && fs::exists(folder / "depth.txt"))
    {
        out.unitsPerMetre = 5000;  // as TUM's folders with lists
    }
    readPublishedCamera(folder, out);
    readOpen3d(folder, out);
    readRecord3d(folder, out);
    readTruth(folder, out);
    return out;
}

/** What there is instead: the first image in the folder or in those in it. */
[[nodiscard]] std::string imageInstead(const fs::path& folder)
{
    const auto images = imagesBut(folder, {});
    return images.empty() ? ". Here are no images"
                          : ". Here is " + relativeTo(folder, images.front());
}
}  // namespace

FolderLayout readFolderLayout(const std::string& folder)
{
    requireFolder(folder);
    for (const auto reader : {scanNet, strayScanner, sevenScenes, replica, oneOrTwoFolders})
    {
        if (auto layout = reader(folder))
        {
            const bool mayBeAlone = reader == oneOrTwoFolders;
            if (layout->depth.empty() || (layout->colour.empty() && !mayBeAlone))
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
        ": not a known layout. Known are ScanNet, 7-Scenes, Redwood, Replica, Bonn, Open3D, "
        "Record3D, StrayScanner; two folders, rgb (or color, colour, image, images) and depth "
        "(depths), with images named by number or stamp, as 12.png, frame_12.png or "
        "1500000000.25.png; one folder with these words in the names, as rgb_12.png and "
        "depth_12.png; depth alone" +
        imageInstead(folder));
}
}  // namespace pointplane
