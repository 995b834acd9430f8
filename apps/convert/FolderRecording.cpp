// SPDX-License-Identifier: BSD-3-Clause
#include "FolderRecording.h"

#include <pointplane/evaluation/association.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iomanip>
#include <map>
#include <sstream>

#include "VideoFrames.h"
#include "even_stamps.h"
#include "folder_cameras.h"
#include "frame_images.h"
#include "quantile.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

constexpr std::uint16_t kNoReading = 65535;  //!< 7-Scenes; farther than any camera sees

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

FolderRecording::FolderRecording(const FolderOptions& options)
    : folder_(options.folder), layout_(readFolderLayout(options.folder))
{
    chooseCamera(options);
    leaveOutDoubles(layout_.colour);
    leaveOutDoubles(layout_.depth);
    pairImages(options);
    if (!layout_.video.empty())
    {
        video_ = std::make_unique<VideoFrames>(layout_.video);
    }
}

FolderRecording::~FolderRecording() = default;

/** By --camera, camera.txt, or what the folder tells. */
void FolderRecording::chooseCamera(const FolderOptions& options)
{
    const std::string local = folder_ + "/camera.txt";
    unitsPerMetre_ = layout_.unitsPerMetre;
    if (!options.camera.empty() || fs::exists(local))
    {
        layout_.calibration = options.camera.empty() ? local : options.camera;
        layout_.camera = loadCameraFile(layout_.calibration);
        layout_.cameraIsNominal = false;
        layout_.depthCamera.reset();
        if (layout_.camera->tellsUnits)
        {
            unitsPerMetre_ = layout_.camera->unitsPerMetre;
        }
    }
    if (!layout_.camera)
    {
        throw InputError(folder_ + ": does not tell its camera; give a calibration by --camera");
    }
    if (options.depthScale > 0)
    {
        unitsPerMetre_ = floatUnits_ = options.depthScale;
    }
    if (const std::string problem = problemOfDepthUnits(unitsPerMetre_); !problem.empty())
    {
        throw InputError(
            folder_ + ": depth units per metre: " + problem + "; give them by --depth-scale");
    }
}

void FolderRecording::pairImages(const FolderOptions& options)
{
    fps_ = options.fps > 0 ? options.fps : layout_.fps.value_or(30);
    if (options.fps <= 0 && !layout_.stampList.empty())
    {
        leaveOutUnlisted();
    }
    hasStamps_ = options.fps <= 0 && areStamped(layout_.colour) && areStamped(layout_.depth);
    if (hasStamps_)
    {
        checkStamps();
        checkOrderOfList();
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
    if (pairs_.empty())
    {
        throw InputError(
            folder_ + ": no colour image belongs to a depth image by its " +
            (hasStamps_ ? "time stamp" : "number"));
    }
}

void FolderRecording::checkNumbers(bool isRateAsked) const
{
    for (const auto* images : {&layout_.colour, &layout_.depth})
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

void FolderRecording::checkStamps() const
{
    for (const auto* images : {&layout_.colour, &layout_.depth})
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
void FolderRecording::leaveOutDoubles(std::vector<ImageRef>& images)
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
void FolderRecording::leaveOutUnlisted()
{
    const auto isListed = [](const ImageRef& image) { return image.stamp.has_value(); };
    for (const auto* images : {&layout_.colour, &layout_.depth})
    {
        if (std::none_of(images->begin(), images->end(), isListed))
        {
            throw InputError(
                layout_.stampList +
                ": tells no stamps of the images beside it; give a rate by --fps");
        }
    }
    for (auto* images : {&layout_.colour, &layout_.depth})
    {
        const auto end = std::stable_partition(images->begin(), images->end(), isListed);
        unlisted_.insert(unlisted_.end(), end, images->end());
        images->erase(end, images->end());
    }
}

/** Names are in order of their stamps, a list need not be. */
void FolderRecording::checkOrderOfList() const
{
    for (const auto* images : {&layout_.colour, &layout_.depth})
    {
        const auto back = std::adjacent_find(
            images->begin(),
            images->end(),
            [](const ImageRef& a, const ImageRef& b)
            { return a.key < b.key && *a.stamp >= *b.stamp; });
        if (!layout_.stampList.empty() && back != images->end())
        {
            std::ostringstream out;
            out << std::setprecision(15) << layout_.stampList << ": the stamp of frame "
                << (back + 1)->key << ", " << *(back + 1)->stamp
                << " s, is not after that of frame " << back->key << ", " << *back->stamp
                << " s; correct it, or give a rate by --fps";
            throw InputError(out.str());
        }
    }
}

void FolderRecording::evenOutStamps()
{
    for (auto* images : {&layout_.depth, &layout_.colour})
    {
        const char* const name = images == &layout_.colour ? ": colour" : ": depth";
        const EvenedStamps even = evenOut(stampsOf(*images), folder_ + name);
        evening_ = even.note;
        for (std::size_t i = 0; i < images->size(); ++i)
        {
            (*images)[i].stamp = even.stamps[i];
        }
    }
}

void FolderRecording::pairByStamp(double maxDifference)
{
    for (const auto& [c, d] :
         associate(stampsOf(layout_.colour), stampsOf(layout_.depth), 0.0, maxDifference))
    {
        pairs_.emplace_back(c, d);
    }
}

void FolderRecording::pairByNumber()
{
    std::map<long, std::size_t> depthOf;
    for (std::size_t i = 0; i < layout_.depth.size(); ++i)
    {
        depthOf.emplace(layout_.depth[i].key, i);
    }
    for (std::size_t i = 0; i < layout_.colour.size(); ++i)
    {
        const auto found = depthOf.find(layout_.colour[i].key);
        if (found != depthOf.end())
        {
            pairs_.emplace_back(i, found->second);
        }
    }
}

double FolderRecording::stampOf(const ImageRef& image) const
{
    return hasStamps_ ? *image.stamp : static_cast<double>(image.key) / fps_;
}

cv::Mat FolderRecording::colourOf(const ImageRef& image)
{
    return video_ ? video_->frame(image.key) : readFrameImage(image.path, cv::IMREAD_COLOR);
}

void FolderRecording::readDepth(const ImageRef& image, RegisteredScan& scan)
{
    cv::Mat depth = readFrameImage(image.path, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR);
    if (depth.type() == CV_32FC1)
    {
        isFloat_ = true;
        setFloatDepth(scan, depth, floatUnits_);
        return;
    }
    if (depth.type() != CV_16UC1)
    {
        throw BadFrame(
            image.path + ": is not a depth image of 16 bit or floating point and one channel");
    }
    depth.setTo(0, depth == kNoReading);
    scan.depth = depth;
    scan.unitsPerMetre = unitsPerMetre_;
}

std::optional<RecordedFrame> FolderRecording::next()
{
    if (next_ == pairs_.size())
    {
        return {};
    }
    const ImageRef& colour = layout_.colour[pairs_[next_].first];
    const ImageRef& depth = layout_.depth[pairs_[next_].second];
    ++next_;
    RecordedFrame out;
    out.scan.stamp = fromSeconds(stampOf(colour));
    if (hasStamps_)
    {
        out.depthDelay = *depth.stamp - *colour.stamp;
    }
    out.isNominal = layout_.cameraIsNominal;
    readDepth(depth, out.scan);
    out.scan.colour = colourOf(colour);
    out.scan.colourFile = colour.path;
    setCameras(out.scan, layout_, colour.path.empty() ? depth.path : colour.path);
    return out;
}

double FolderRecording::progress() const
{
    return static_cast<double>(next_) / static_cast<double>(pairs_.size());
}

std::string FolderRecording::noteOfSteps() const
{
    constexpr double kLong = 0.5;  // [s] between frames: slower than anybody records
    std::vector<double> steps;
    for (std::size_t i = 1; i < pairs_.size(); ++i)
    {
        const long key = layout_.colour[pairs_[i].first].key;
        steps.push_back(static_cast<double>(key - layout_.colour[pairs_[i - 1].first].key));
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
std::vector<std::string> FolderRecording::notesOfLeftOut() const
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
    for (const std::string& source : layout_.otherSources)
    {
        out.push_back(
            source + " was left out: there are images in " + folderOf(layout_.colour) + " and " +
            folderOf(layout_.depth) + "; move away what is not meant");
    }
    add(unlisted_.size(),
        "without a stamp in " + layout_.stampList +
            " were left out; --fps takes them, too, at a rate of its own");
    add(layout_.colour.size() + layout_.depth.size() - 2 * pairs_.size(),
        "without a partner were left out");
    if (!doubles_.empty())
    {
        add(doubles_.size(),
            "of a number or time that another one has were left out: " +
                examples(doubles_.front().path, doubles_.size()));
    }
    std::vector<ImageRef> known = doubles_;
    for (const auto* images : {&unlisted_, &layout_.colour, &layout_.depth})
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

std::vector<std::string> FolderRecording::notes() const
{
    std::ostringstream layout;
    layout << "read as " << layout_.name << ", " << (isFloat_ ? floatUnits_ : unitsPerMetre_)
           << " depth units per metre, ";
    if (hasStamps_)
    {
        layout << "stamps of the recording";
    }
    else
    {
        layout << "frames numbered at " << fps_ << " Hz";
    }
    std::vector<std::string> out{layout.str()};
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
    if (layout_.cameraIsNominal)
    {
        out.emplace_back("camera: nominal, that of the data set; --camera takes a calibration");
    }
    const std::vector<std::string> leftOut = notesOfLeftOut();
    out.insert(out.end(), leftOut.begin(), leftOut.end());
    return out;
}
}  // namespace pointplane
