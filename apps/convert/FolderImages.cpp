// SPDX-License-Identifier: BSD-3-Clause
#include "FolderImages.h"

#include <pointplane/core/counted.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace pointplane
{
namespace
{
[[nodiscard]] std::string folderOfImages(const std::vector<ImageRef>& images)
{
    return std::filesystem::path(images.front().path).parent_path().string();
}
}  // namespace

FolderImages::FolderImages(const FolderLayout& layout)
    : colour(layout.colour),
      depth(layout.depth),
      stampList_(layout.stampList),
      otherSources_(layout.otherSources)
{
    leaveOutDoubles(colour);
    leaveOutDoubles(depth);
}

bool FolderImages::areStamped() const
{
    const auto isStamped = [](const ImageRef& image) { return image.stamp.has_value(); };
    return std::all_of(colour.begin(), colour.end(), isStamped) &&
           std::all_of(depth.begin(), depth.end(), isStamped);
}

void FolderImages::leaveOutDoubles(std::vector<ImageRef>& images)
{
    std::vector<ImageRef> taken;
    for (const ImageRef& image : images)
    {
        const bool isDouble =
            !taken.empty() && taken.back().key == image.key && taken.back().stamp == image.stamp;
        if (!isDouble)
        {
            taken.push_back(image);
        }
        else if (!image.path.empty())  // else it is a frame of a video
        {
            doubles_.push_back(image);
        }
    }
    images = taken;
}

void FolderImages::leaveOutUnlisted()
{
    if (stampList_.empty())
    {
        return;
    }
    const auto isListed = [](const ImageRef& image) { return image.stamp.has_value(); };
    for (const auto* images : {&colour, &depth})
    {
        if (!images->empty() && std::none_of(images->begin(), images->end(), isListed))
        {
            throw InputError(
                stampList_ + ": tells no stamps of the images beside it; give a rate by --fps");
        }
    }
    for (auto* images : {&colour, &depth})
    {
        const auto end = std::stable_partition(images->begin(), images->end(), isListed);
        unlisted_.insert(unlisted_.end(), end, images->end());
        images->erase(end, images->end());
    }
}

void FolderImages::checkOrderOfList(bool mayRepeat) const
{
    for (const auto* images : {&colour, &depth})
    {
        const auto back = std::adjacent_find(
            images->begin(),
            images->end(),
            [&](const ImageRef& a, const ImageRef& b)
            { return a.key < b.key && (mayRepeat ? *a.stamp > *b.stamp : *a.stamp >= *b.stamp); });
        if (!stampList_.empty() && back != images->end())
        {
            std::ostringstream out;
            out << std::setprecision(15) << stampList_ << ": the stamp of frame " << (back + 1)->key
                << ", " << *(back + 1)->stamp << " s, is not after that of frame " << back->key
                << ", " << *back->stamp << " s; correct it, or give a rate by --fps"
                << (*back->stamp == *(back + 1)->stamp ? ", or use --even-stamps" : "");
            throw InputError(out.str());
        }
    }
}

std::vector<std::string> FolderImages::notesOfLeftOut(std::size_t numFrames) const
{
    std::vector<std::string> out;
    const auto add = [&out](std::size_t count, const std::string& which, const std::string& more)
    {
        if (count > 0)
        {
            out.push_back(
                counted(count, "image") + " " + which + (count == 1 ? " was" : " were") +
                " left out" + more);
        }
    };
    const auto examples = [](const std::string& first, std::size_t count)
    { return first + (count > 1 ? ", ..." : ""); };
    for (const std::string& source : otherSources_)
    {
        out.push_back(
            source + " was left out: there are images in " +
            (isDepthAlone() ? "" : folderOfImages(colour) + " and ") + folderOfImages(depth) +
            "; move away what is not meant");
    }
    add(unlisted_.size(),
        "without a stamp in " + stampList_,
        "; --fps takes all, at a rate of its own");
    if (!isDepthAlone())
    {
        add(colour.size() + depth.size() - 2 * numFrames, "without a partner", "");
    }
    if (!doubles_.empty())
    {
        add(doubles_.size(),
            "of a number or time that another one has",
            ": " + examples(doubles_.front().path, doubles_.size()));
    }
    std::vector<ImageRef> known = doubles_;
    for (const auto* images : {&unlisted_, &colour, &depth})
    {
        known.insert(known.end(), images->begin(), images->end());
    }
    if (const auto others = imagesBeside(known); !others.empty())
    {
        add(others.size(),
            others.size() == 1 ? "whose name is no number" : "whose names are no number",
            ": " + examples(others.front(), others.size()));
    }
    return out;
}
}  // namespace pointplane
