// SPDX-License-Identifier: BSD-3-Clause
#include "OverlaySink.h"

#include <pointplane/core/counted.h>
#include <pointplane/mrpt_io/image_file.h>
#include <pointplane/mrpt_io/mrpt_camera.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace pointplane
{
namespace
{
const cv::Size kUsualSize(640, 480);
}  // namespace

OverlaySink::OverlaySink(const std::string& folder, std::size_t every)
    : folder_(folder), every_(every)
{
}

/** That of its images; if there are none, that of the latest ones: a video has one size. */
cv::Size OverlaySink::sizeOf(const OutputItem& item)
{
    const RgbdFrame& frame = item.source.converted->frame;
    if (!frame.gray.empty() || !frame.depth.empty())
    {
        size_ = frame.gray.empty() ? frame.depth.size() : frame.gray.size();
    }
    else if (const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(
                 item.source.observation);
             !size_ && scan)
    {
        const PinholeCamera camera =
            fromMrpt(scan->hasIntensityImage ? scan->cameraParamsIntensity : scan->cameraParams);
        // Those of a damaged scan may be any numbers.
        const bool isUsual =
            camera.problem().empty() && std::max(camera.width, camera.height) < 1e4;
        return isUsual ? cv::Size(camera.width, camera.height) : kUsualSize;
    }
    return size_.value_or(kUsualSize);
}

/** Since the latest frame that was measured. That of others is a guess: what it was wrong by would
 * count as a motion in the time of one frame. */
std::optional<CameraSpeed> OverlaySink::speedAt(const OutputItem& item)
{
    if (!isMeasured(item.frame->motion.status))
    {
        return {};
    }
    const double stamp = item.source.converted->frame.stamp;
    const Eigen::Isometry3d pose = item.frame->motion.cameraPose.mean;
    const Eigen::Isometry3d motion = measuredPose_.inverse() * pose;
    const double dt = stamp - measuredStamp_.value_or(stamp);
    measuredPose_ = pose;
    measuredStamp_ = stamp;
    if (dt <= 0)
    {
        return {};
    }
    return CameraSpeed{motion.translation() / dt, Eigen::AngleAxisd(motion.linear()).angle() / dt};
}

void OverlaySink::add(const OutputItem& item)
{
    if (!item.frame)
    {
        return;
    }
    const double stamp = item.source.converted->frame.stamp;
    const auto speed = speedAt(item);
    const cv::Size size = sizeOf(item);
    if (!firstStamp_ && std::isfinite(stamp))
    {
        firstStamp_ = stamp;
    }
    if (numFrames_++ % every_ != 0)
    {
        return;
    }
    constexpr int kQuality = 90;
    char name[32];
    std::snprintf(name, sizeof(name), "%06zu.jpg", item.source.frameIndex);
    const cv::Mat picture = drawOverlay(item, stamp - firstStamp_.value_or(stamp), speed, size);
    writeJpegFile(folder_.fileAt(name), picture, kQuality);
    names_.insert(name);
}

/** Names of files that this run would have given, and has not. */
std::set<std::string> OverlaySink::earlierPictures() const
{
    constexpr std::size_t kFewestDigits = 6;
    std::set<std::string> out;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path(), error))
    {
        const std::string name = entry.path().filename(), stem = entry.path().stem();
        const bool isNumber = stem.size() >= kFewestDigits &&
                              stem.find_first_not_of("0123456789") == std::string::npos;
        if (isNumber && entry.path().extension() == ".jpg" && names_.count(name) == 0)
        {
            out.insert(name);
        }
    }
    return out;
}

std::string OverlaySink::description() const
{
    const auto earlier = earlierPictures();
    return folder_.path() + ": " + counted(names_.size(), "picture") +
           (earlier.empty() ? ""
                            : ", and " + std::to_string(earlier.size()) +
                                  " of an earlier run, e.g. " + *earlier.begin());
}
}  // namespace pointplane
