// SPDX-License-Identifier: BSD-3-Clause
#include "FolderRecording.h"

#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <opencv2/imgcodecs.hpp>

#include <cstdint>
#include <filesystem>
#include <sstream>

#include "VideoFrames.h"
#include "folder_cameras.h"
#include "frame_images.h"
#include "tum_line.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;
}  // namespace

FolderRecording::FolderRecording(const FolderOptions& options)
    : folder_(options.folder), layout_(readFolderLayout(options.folder))
{
    chooseCamera(options);
    frames_ = FolderFrames(layout_, options);
    readPoses();
    if (!layout_.video.empty())
    {
        video_ = std::make_unique<VideoFrames>(layout_.video);
    }
    else if (!frames_.areDepthAlone())
    {
        requireColour(frames_.all().front().colour.path);
    }
}

FolderRecording::~FolderRecording() = default;

/** Of the camera that the frames are seen by. */
void FolderRecording::readPoses()
{
    groundTruth_ = layout_.groundTruth;
    const Eigen::Isometry3d T_depth_cam =
        frames_.areDepthAlone() ? Eigen::Isometry3d::Identity() : layout_.T_depth_colour;
    for (const FolderFrames::Frame& frame : frames_.all())
    {
        if (const auto T_world_depth = layout_.poseOf ? layout_.poseOf(frame.depth) : std::nullopt)
        {
            groundTruth_ += tumLine(fromSeconds(frame.stamp), *T_world_depth * T_depth_cam) + "\n";
            ++numPoses_;
        }
    }
}

/** By --camera, camera.txt, or what the folder tells. */
void FolderRecording::chooseCamera(const FolderOptions& options)
{
    const std::string local = folder_ + "/camera.txt";
    unitsPerMetre_ = layout_.unitsPerMetre;
    if (!options.camera.empty() || fs::exists(local))
    {
        layout_.calibration = options.camera.empty() ? local : options.camera;
        layout_.camera = loadCalibrationFile(layout_.calibration);
        layout_.cameraIsNominal = false;
        if (layout_.camera->tellsUnits)
        {
            unitsPerMetre_ = layout_.camera->unitsPerMetre;
        }
    }
    if (!layout_.camera)
    {
        throw InputError(
            folder_ + ": does not tell its camera; give a calibration by --camera" +
            (fs::exists(folder_ + "/depth.txt")
                 ? "; pointplane-convert tum takes folders with lists, and knows TUM's cameras"
                 : ""));
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

cv::Mat FolderRecording::colourOf(const ImageRef& image)
{
    return video_ ? video_->frame(image.key) : readFrameImage(image.path, cv::IMREAD_COLOR);
}

void FolderRecording::readDepth(const ImageRef& image, RecordedFrame& frame)
{
    cv::Mat depth = readFrameImage(image.path, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR);
    if (depth.type() == CV_32FC1)
    {
        isFloat_ = true;
        setFloatDepth(frame, depth, floatUnits_);
        return;
    }
    if (depth.type() != CV_16UC1)
    {
        throw BadFrame(
            image.path +
            ": is not a depth image of 16 bit or floating point and one channel, but "
            "of " +
            typeText(depth));
    }
    depth.setTo(0, depth == kSaturatedDepth);
    frame.scan.depth = depth;
    frame.scan.unitsPerMetre = unitsPerMetre_;
}

std::optional<RecordedFrame> FolderRecording::next()
{
    if (next_ == frames_.all().size())
    {
        return {};
    }
    const FolderFrames::Frame& frame = frames_.all()[next_++];
    RecordedFrame out;
    out.scan.stamp = fromSeconds(frame.stamp);
    out.depthDelay = frame.depthDelay;
    out.isNominal = layout_.cameraIsNominal;
    readDepth(frame.depth, out);
    if (!frames_.areDepthAlone())
    {
        out.scan.colour = colourOf(frame.colour);
        out.scan.colourFile = frame.colour.path;
    }
    setCameras(out.scan, layout_, frame.colour.path.empty() ? frame.depth.path : frame.colour.path);
    return out;
}

double FolderRecording::progress() const
{
    return static_cast<double>(next_) / static_cast<double>(frames_.all().size());
}

std::vector<std::string> FolderRecording::notes() const
{
    std::ostringstream layout;
    layout << "read as " << layout_.name << ", " << (isFloat_ ? floatUnits_ : unitsPerMetre_)
           << " depth units per metre, " << frames_.whatStampsAre();
    std::vector<std::string> out{layout.str()};
    if (layout_.poseOf)
    {
        out.push_back(
            "poses of " + std::to_string(numPoses_) + " of " +
            std::to_string(frames_.all().size()) + " frames");
    }
    if (!layout_.aboutTruth.empty())
    {
        out.push_back(layout_.aboutTruth);
    }
    if (frames_.areDepthAlone())
    {
        out.emplace_back(
            "no colour images: frames have depth alone, and only planes tell the motion");
    }
    if (layout_.cameraIsNominal)
    {
        out.emplace_back("camera: nominal, that of the data set; --camera takes a calibration");
    }
    if (layout_.camera && !layout_.camera->unused.empty() && !layout_.depthCamera)
    {
        out.push_back(layout_.camera->unused);
    }
    const std::vector<std::string> ofFrames = frames_.notes();
    out.insert(out.end(), ofFrames.begin(), ofFrames.end());
    return out;
}
}  // namespace pointplane
