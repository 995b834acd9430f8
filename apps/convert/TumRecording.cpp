// SPDX-License-Identifier: BSD-3-Clause
#include "TumRecording.h"

#include <pointplane/core/counted.h>
#include <pointplane/core/number_text.h>
#include <pointplane/core/quantile.h>
#include <pointplane/evaluation/association.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "even_stamps.h"
#include "frame_images.h"
#include "layout_files.h"
#include "stamp_check.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

[[nodiscard]] std::vector<double> secondsOf(const std::vector<TumImage>& images)
{
    std::vector<double> out;
    std::transform(
        images.begin(),
        images.end(),
        std::back_inserter(out),
        [](const TumImage& image) { return image.seconds; });
    return out;
}

/** \return what was done, for people */
[[nodiscard]] std::string evenOutStamps(std::vector<TumImage>& images, const std::string& listing)
{
    const EvenedStamps even = evenOut(secondsOf(images), listing);
    for (std::size_t i = 0; i < images.size(); ++i)
    {
        images[i].seconds = even.stamps[i];
        images[i].stamp = fromSeconds(even.stamps[i]);
    }
    return even.note;
}

/** "colour from 1.2 to 3.4 s" */
[[nodiscard]] std::string rangeOf(const char* kind, const std::vector<TumImage>& images)
{
    return std::string(kind) + " from " + numberText(images.front().seconds, 3) + " to " +
           numberText(images.back().seconds, 3) + " s";
}

/** An image of the camera's size. */
[[nodiscard]] cv::Mat readImage(const std::string& path, int flags, const PinholeCamera& camera)
{
    const cv::Mat image = readFrameImage(path, flags);
    const cv::Size size(camera.width, camera.height);
    if (image.size() != size)
    {
        throw BadFrame(
            path + ": is " + sizeText(image.size()) + " but the camera is for " + sizeText(size));
    }
    return image;
}

}  // namespace

TumRecording::TumRecording(const TumOptions& options) : options_(options)
{
    requireFolder(options.folder);
    readLists();
    camera_ = loadCalibration(options.camera, options.folder);
    if (options.depthScale > 0)
    {
        camera_.unitsPerMetre = options.depthScale;
    }
    pairImages();
    truth_ = readTumTruth(options.folder);
}

void TumRecording::readLists()
{
    const std::string ofColour = options_.folder + "/rgb.txt";
    const std::string ofDepth = options_.folder + "/depth.txt";
    const bool isListed = fs::exists(fs::symlink_status(ofColour));
    if (isListed || !fs::exists(ofDepth))
    {
        colour_ = readTumListing(options_.folder, "rgb.txt");
    }
    depth_ = readTumListing(options_.folder, "depth.txt");
    if (options_.evenStamps)
    {
        evening_ = evenOutStamps(depth_, ofDepth);
        if (!colour_.empty())
        {
            evening_ = evenOutStamps(colour_, ofColour);
        }
    }
}

void TumRecording::pairImages()
{
    requireTimes(secondsOf(colour_), options_.folder + "/rgb.txt");
    requireTimes(secondsOf(depth_), options_.folder + "/depth.txt");
    if (colour_.empty())
    {
        for (std::size_t i = 0; i < depth_.size(); ++i)
        {
            frames_.push_back({{}, i});
        }
        return;
    }
    for (const auto& [c, d] :
         associate(secondsOf(colour_), secondsOf(depth_), 0.0, options_.maxDifference))
    {
        frames_.push_back({c, d});
    }
    if (frames_.empty())
    {
        throw InputError(
            options_.folder + ": no colour and depth stamps within " +
            numberText(options_.maxDifference) + " s of each other: " + rangeOf("colour", colour_) +
            ", " + rangeOf("depth", depth_) +
            " (stamps must be in seconds; --max-difference takes a longer time)");
    }
    requireColour(colour_[*frames_.front().colour].path);
}

double TumRecording::delayOf(const Frame& frame) const
{
    return frame.colour ? depth_[frame.depth].seconds - colour_[*frame.colour].seconds : 0;
}

std::optional<RecordedFrame> TumRecording::next()
{
    if (next_ == frames_.size())
    {
        return {};
    }
    const Frame& frame = frames_[next_++];
    const TumImage& depth = depth_[frame.depth];
    RecordedFrame out;
    // Some colour images go with the depth image before, some with that after: 33 ms apart.
    out.depthDelay = delayOf(frame);
    out.scan.stamp = frame.colour ? colour_[*frame.colour].stamp : depth.stamp;
    out.scan.camera = camera_.camera;
    out.scan.unitsPerMetre = camera_.unitsPerMetre;
    out.scan.depth =
        readImage(depth.path, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR, camera_.camera);
    if (out.scan.depth.type() != CV_16UC1)
    {
        throw BadFrame(
            depth.path + ": is not a depth image of 16 bit and one channel, but of " +
            typeText(out.scan.depth) +
            (out.scan.depth.depth() == CV_32F ? "; pointplane-convert folder reads that" : ""));
    }
    if (frame.colour)
    {
        out.scan.colourFile = colour_[*frame.colour].path;
        out.scan.colour = readImage(out.scan.colourFile, cv::IMREAD_COLOR, camera_.camera);
    }
    return out;
}

double TumRecording::progress() const
{
    return static_cast<double>(next_) / static_cast<double>(frames_.size());
}

std::vector<std::string> TumRecording::notes() const
{
    std::vector<std::string> out = notesOfPairs();
    if (!camera_.guessed.empty())
    {
        out.push_back(
            "camera: " + camera_.guessed + ", by the folder's name; --camera takes another");
    }
    for (const std::string& note : {camera_.unused, evening_, truth_.note})
    {
        if (!note.empty())
        {
            out.push_back(note);
        }
    }
    if (!colour_.empty())
    {
        std::vector<double> delays;
        for (const Frame& frame : frames_)
        {
            delays.push_back(delayOf(frame));
        }
        std::ostringstream delay;
        delay << "depth after colour: " << std::round(1e4 * median(delays)) / 10 << " ms (median)";
        out.push_back(delay.str());
    }
    return out;
}

std::vector<std::string> TumRecording::notesOfPairs() const
{
    if (colour_.empty())
    {
        return {
            options_.folder +
            ": has no rgb.txt, so frames have depth alone, and only planes tell the motion"};
    }
    const std::size_t colourAlone = colour_.size() - frames_.size();
    const std::size_t depthAlone = depth_.size() - frames_.size();
    if (colourAlone + depthAlone == 0)
    {
        return {};
    }
    std::ostringstream alone;
    alone << "left out, without a partner within " << options_.maxDifference
          << " s: " << colourAlone << " colour and " << counted(depthAlone, "depth image");
    return {alone.str()};
}

std::vector<std::string> TumRecording::files() const
{
    std::vector<std::string> out{options_.camera};
    for (const char* name : {"rgb.txt", "depth.txt", "camera.txt", "groundtruth.txt"})
    {
        out.push_back(options_.folder + "/" + name);
    }
    for (const auto* images : {&colour_, &depth_})
    {
        for (const TumImage& image : *images)
        {
            out.push_back(image.path);
        }
    }
    return out;
}
}  // namespace pointplane
