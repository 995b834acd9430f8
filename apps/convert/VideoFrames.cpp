// SPDX-License-Identifier: BSD-3-Clause
#include "VideoFrames.h"

#include <pointplane/core/check.h>

#include <filesystem>

#include "Recording.h"

namespace pointplane
{
VideoFrames::VideoFrames(const std::string& path) : path_(path)
{
    if (!std::filesystem::exists(path) || !capture_.open(path))
    {
        throw InputError(
            "cannot open " + path +
            "; extract its frames to a folder rgb: ffmpeg -i rgb.mp4 rgb/%06d.png "
            "-start_number 0");
    }
    // As they were taken: depth and intrinsics know nothing of how a phone was held.
    capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
}

cv::Mat VideoFrames::frame(long key)
{
    POINTPLANE_CHECK(key >= next_, path_ << ": frame " << key << " was read before");
    cv::Mat image;
    for (; next_ <= key; ++next_)
    {
        if (!capture_.read(image))
        {
            throw BadFrame(path_ + ": has no frame " + std::to_string(key));
        }
    }
    return image;
}
}  // namespace pointplane
