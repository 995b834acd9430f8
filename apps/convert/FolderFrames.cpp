// SPDX-License-Identifier: BSD-3-Clause
#include "FolderFrames.h"

#include <pointplane/evaluation/association.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <map>
#include <sstream>

#include "even_stamps.h"
#include "quantile.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

constexpr double kUnknownDelay = std::numeric_limits<double>::quiet_NaN();

[[nodiscard]] std::vector<double> stampsOf(const std::vector<ImageRef>& images)
{
    std::vector<double> out;
    for (const ImageRef& image : images)
    {
        out.push_back(*image.stamp);
    }
    return out;
}

[[nodiscard]] std::string folderOf(const std::vector<ImageRef>& images)
{
    return fs::path(images.front().path).parent_path().string();
}

[[nodiscard]] bool areStamped(const std::vector<ImageRef>& images)
{
    return std::all_of(
        images.begin(), images.end(), [](const ImageRef& image) { return image.stamp; });
}
}  // namespace

FolderFrames::FolderFrames(const FolderLayout& layout, const FolderOptions& options)
    : folder_(options.folder),
      stampList_(layout.stampList),
      otherSources_(layout.otherSources),
      colour_(layout.colour),
      depth_(layout.depth),
      fps_(options.fps > 0 ? options.fps : layout.fps.value_or(30))
{
    leaveOutDoubles(colour_);
    leaveOutDoubles(depth_);
    pairImages(options);
}

void FolderFrames::pairImages(const FolderOptions& options)
{
    if (options.fps <= 0 && !stampList_.empty())
    {
        leaveOutUnlisted();
    }
    hasStamps_ = options.fps <= 0 && areStamped(colour_) && areStamped(depth_);
    if (hasStamps_)
    {
        checkStamps();
        checkOrderOfList(options.evenStamps);
        if (options.evenStamps)
        {
            evenOutStamps();
        }
        pairByStamp(options.maxDifference);
    }
    else if (options.evenStamps)
    {
        throw InputError(folder_ + ": has no stamps that --even-stamps could even out");
    }
    else
    {
        if (options.fps <= 0 && fs::exists(folder_ + "/rgb.txt") &&
            fs::exists(folder_ + "/depth.txt"))
        {
            throw InputError(
                folder_ +
                ": rgb.txt and depth.txt tell the stamps of its numbered images; convert it by "
                "pointplane-convert tum, or give a rate by --fps");
        }
        checkNumbers(options.fps > 0);
        pairByNumber();
        checkStamps();
    }
    if (frames_.empty())
    {
        throw InputError(
            folder_ + ": no colour image belongs to a depth image by its " +
            (hasStamps_ ? "time stamp" : "number"));
    }
}

void FolderFrames::checkNumbers(bool isRateAsked) const
{
    for (const auto* images : {&colour_, &depth_})
    {
        for (const ImageRef& image : *images)
        {
            if (!image.isNumbered)
            {
                throw InputError(
                    image.path + ": is named by a time, not by a number" +
                    (isRateAsked ? "; leave --fps out" : ", but other images are numbered"));
            }
        }
    }
}

void FolderFrames::checkStamps() const
{
    for (const auto* images : {&colour_, &depth_})
    {
        for (const ImageRef& image : *images)
        {
            const double stamp = stampOf(image);
            if (!(stamp >= 0 && stamp <= static_cast<double>(kLatestStamp)))
            {
                std::ostringstream out;
                out << (image.path.empty() ? folder_ : image.path) << ": its time, " << stamp
                    << " s, is not a time stamp; check stamps or rate";
                throw InputError(out.str());
            }
        }
    }
}

/** 7.png beside 7.jpg: the first one is taken. */
void FolderFrames::leaveOutDoubles(std::vector<ImageRef>& images)
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

/** Images of which the list tells nothing, if it tells of others. */
void FolderFrames::leaveOutUnlisted()
{
    const auto isListed = [](const ImageRef& image) { return image.stamp.has_value(); };
    for (const auto* images : {&colour_, &depth_})
    {
        if (std::none_of(images->begin(), images->end(), isListed))
        {
            throw InputError(
                stampList_ + ": tells no stamps of the images beside it; give a rate by --fps");
        }
    }
    for (auto* images : {&colour_, &depth_})
    {
        const auto end = std::stable_partition(images->begin(), images->end(), isListed);
        unlisted_.insert(unlisted_.end(), end, images->end());
        images->erase(end, images->end());
    }
}

/** Names are in order of their stamps, a list need not be. \param mayRepeat one after the other */
void FolderFrames::checkOrderOfList(bool mayRepeat) const
{
    for (const auto* images : {&colour_, &depth_})
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

void FolderFrames::evenOutStamps()
{
    for (auto* images : {&depth_, &colour_})
    {
        const char* const name = images == &colour_ ? ": colour" : ": depth";
        const EvenedStamps even = evenOut(stampsOf(*images), folder_ + name);
        evening_ = even.note;
        for (std::size_t i = 0; i < images->size(); ++i)
        {
            (*images)[i].stamp = even.stamps[i];
        }
    }
}

void FolderFrames::pairByStamp(double maxDifference)
{
    for (const auto& [c, d] : associate(stampsOf(colour_), stampsOf(depth_), 0.0, maxDifference))
    {
        const ImageRef& colour = colour_[c];
        frames_.push_back({colour, depth_[d], *colour.stamp, *depth_[d].stamp - *colour.stamp});
    }
}

void FolderFrames::pairByNumber()
{
    std::map<long, const ImageRef*> depthOf;
    for (const ImageRef& depth : depth_)
    {
        depthOf.emplace(depth.key, &depth);
    }
    for (const ImageRef& colour : colour_)
    {
        const auto found = depthOf.find(colour.key);
        if (found != depthOf.end())
        {
            frames_.push_back({colour, *found->second, stampOf(colour), kUnknownDelay});
        }
    }
}

double FolderFrames::stampOf(const ImageRef& image) const
{
    return hasStamps_ ? *image.stamp : static_cast<double>(image.key) / fps_;
}

std::string FolderFrames::noteOfSteps() const
{
    constexpr double kLong = 0.5;  // [s] between frames: slower than anybody records
    std::vector<double> steps;
    for (std::size_t i = 1; i < frames_.size(); ++i)
    {
        steps.push_back(static_cast<double>(frames_[i].colour.key - frames_[i - 1].colour.key));
    }
    const double step = steps.empty() ? 1 : quantile(steps, 0.5);
    if (step <= 1)
    {
        return "";
    }
    std::ostringstream out;
    out << std::setprecision(9) << "numbers rise by " << step << ", so frames are " << step / fps_
        << " s apart";
    if (step / fps_ > kLong)
    {
        out << ": are they times? Then give how many of them are a second by --fps, 1000 for "
               "milliseconds";
    }
    return out.str();
}

/** Images that are in the folder and not in the rawlog. */
std::vector<std::string> FolderFrames::notesOfLeftOut() const
{
    std::vector<std::string> out;
    const auto add = [&out](std::size_t count, const std::string& text)
    {
        if (count > 0)
        {
            out.push_back(std::to_string(count) + " images " + text);
        }
    };
    const auto examples = [](const std::string& first, std::size_t count)
    { return first + (count > 1 ? ", ..." : ""); };
    for (const std::string& source : otherSources_)
    {
        out.push_back(
            source + " was left out: there are images in " + folderOf(colour_) + " and " +
            folderOf(depth_) + "; move away what is not meant");
    }
    add(unlisted_.size(),
        "without a stamp in " + stampList_ +
            " were left out; --fps takes them, too, at a rate of its own");
    add(colour_.size() + depth_.size() - 2 * frames_.size(), "without a partner were left out");
    if (!doubles_.empty())
    {
        add(doubles_.size(),
            "of a number or time that another one has were left out: " +
                examples(doubles_.front().path, doubles_.size()));
    }
    std::vector<ImageRef> known = doubles_;
    for (const auto* images : {&unlisted_, &colour_, &depth_})
    {
        known.insert(known.end(), images->begin(), images->end());
    }
    if (const auto others = imagesBeside(known); !others.empty())
    {
        add(others.size(),
            "whose names are no number were left out: " + examples(others.front(), others.size()));
    }
    return out;
}

std::string FolderFrames::whatStampsAre() const
{
    std::ostringstream out;
    if (hasStamps_)
    {
        out << "stamps of the recording";
    }
    else
    {
        out << "frames numbered at " << fps_ << " Hz";
    }
    return out.str();
}

std::vector<std::string> FolderFrames::notes() const
{
    std::vector<std::string> out;
    if (!evening_.empty())
    {
        out.push_back(evening_);
    }
    if (!hasStamps_)
    {
        out.emplace_back(
            "stamps: regular by number only; say --fps if the rate is another one, and do not use "
            "the velocity of a recording that dropped frames");
        if (const std::string steps = noteOfSteps(); !steps.empty())
        {
            out.push_back(steps);
        }
    }
    const std::vector<std::string> leftOut = notesOfLeftOut();
    out.insert(out.end(), leftOut.begin(), leftOut.end());
    return out;
}
}  // namespace pointplane
