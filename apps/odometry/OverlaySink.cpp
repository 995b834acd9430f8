// SPDX-License-Identifier: BSD-3-Clause
#include "OverlaySink.h"

#include <pointplane/core/counted.h>
#include <pointplane/mrpt_io/image_file.h>

#include <cstdio>
#include <filesystem>

namespace pointplane
{
OverlaySink::OverlaySink(const std::string& folder, std::size_t every)
    : folder_(folder), every_(every)
{
}

/** Since the frame before. */
std::optional<CameraSpeed> OverlaySink::speedAt(const OutputItem& item)
{
    const double stamp = item.source.converted->frame.stamp;
    const Eigen::Isometry3d pose = item.frame->motion.cameraPose.mean;
    const Eigen::Isometry3d motion = latestPose_.inverse() * pose;
    const double dt = stamp - latestStamp_.value_or(stamp);
    latestPose_ = pose;
    latestStamp_ = stamp;
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
    firstStamp_ = firstStamp_.value_or(stamp);
    if (numFrames_++ % every_ != 0)
    {
        return;
    }
    constexpr int kQuality = 90;
    char name[32];
    std::snprintf(name, sizeof(name), "%06zu.jpg", item.source.frameIndex);
    const cv::Mat picture = drawOverlay(item, stamp - *firstStamp_, speed);
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
