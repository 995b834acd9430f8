// SPDX-License-Identifier: BSD-3-Clause
#include "FolderFrames.h"

#include <pointplane/core/quantile.h>
#include <pointplane/evaluation/association.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <filesystem>
#include <iomanip>
#include <limits>
#include <map>
#include <sstream>

#include "even_stamps.h"

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
}  // namespace

FolderFrames::FolderFrames(const FolderLayout& layout, const FolderOptions& options)
    : folder_(options.folder),
      images_(layout),
      fps_(options.fps > 0 ? options.fps : layout.fps.value_or(30))
{
    pairImages(options);
}

void FolderFrames::pairImages(const FolderOptions& options)
{
    if (options.fps <= 0)
    {
        images_.leaveOutUnlisted();
    }
    hasStamps_ = options.fps <= 0 && images_.areStamped();
    if (hasStamps_)
    {
        checkStamps();
        images_.checkOrderOfList(options.evenStamps);
        if (options.evenStamps)
        {
            evenOutStamps();
        }
        images_.isDepthAlone() ? takeDepthAlone() : pairByStamp(options.maxDifference);
    }
    else if (options.evenStamps)
    {
        throw InputError(folder_ + ": has no stamps that --even-stamps could even out");
    }
    else
    {
        if (options.fps <= 0)
        {
            checkLists();
        }
        checkNumbers(options.fps > 0);
        images_.isDepthAlone() ? takeDepthAlone() : pairByNumber();
        checkStamps();
    }
    if (frames_.empty())
    {
        throw InputError(
            folder_ + ": no colour image belongs to a depth image by its " +
            (hasStamps_ ? "time stamp" : "number"));
    }
}

/** \throws InputError if lists as TUM's tell the stamps of the numbered images */
void FolderFrames::checkLists() const
{
    const bool isAlone = images_.isDepthAlone();
    if (fs::exists(folder_ + "/depth.txt") && (isAlone || fs::exists(folder_ + "/rgb.txt")))
    {
        throw InputError(
            folder_ + (isAlone ? ": depth.txt tells" : ": rgb.txt and depth.txt tell") +
            " the stamps of its numbered images; convert it by pointplane-convert tum, or give a "
            "rate by --fps");
    }
}

void FolderFrames::checkNumbers(bool isRateAsked) const
{
    for (const auto* images : {&images_.colour, &images_.depth})
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
    for (const auto* images : {&images_.colour, &images_.depth})
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

void FolderFrames::evenOutStamps()
{
    const auto evenOutOf = [this](std::vector<ImageRef>& images, const char* name)
    {
        const EvenedStamps even = evenOut(stampsOf(images), folder_ + ": " + name);
        evening_ = even.note;
        for (std::size_t i = 0; i < images.size(); ++i)
        {
            images[i].stamp = even.stamps[i];
        }
    };
    evenOutOf(images_.depth, "depth");
    if (!images_.isDepthAlone())
    {
        evenOutOf(images_.colour, "colour");  // its note is told
    }
}

void FolderFrames::pairByStamp(double maxDifference)
{
    for (const auto& [c, d] :
         associate(stampsOf(images_.colour), stampsOf(images_.depth), 0.0, maxDifference))
    {
        const ImageRef& colour = images_.colour[c];
        frames_.push_back(
            {colour, images_.depth[d], *colour.stamp, *images_.depth[d].stamp - *colour.stamp});
    }
}

void FolderFrames::pairByNumber()
{
    std::map<long, const ImageRef*> depthOf;
    for (const ImageRef& depth : images_.depth)
    {
        depthOf.emplace(depth.key, &depth);
    }
    for (const ImageRef& colour : images_.colour)
    {
        const auto found = depthOf.find(colour.key);
        if (found != depthOf.end())
        {
            frames_.push_back({colour, *found->second, stampOf(colour), kUnknownDelay});
        }
    }
}

void FolderFrames::takeDepthAlone()
{
    for (const ImageRef& depth : images_.depth)
    {
        frames_.push_back({ImageRef(), depth, stampOf(depth), 0});
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
        steps.push_back(static_cast<double>(frames_[i].depth.key - frames_[i - 1].depth.key));
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

std::string FolderFrames::whatStampsAre() const
{
    if (hasStamps_)
    {
        return "stamps of the recording";
    }
    std::ostringstream out;
    out << "frames numbered at " << fps_ << " Hz";
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
    const std::vector<std::string> leftOut = images_.notesOfLeftOut(frames_.size());
    out.insert(out.end(), leftOut.begin(), leftOut.end());
    return out;
}
}  // namespace pointplane
