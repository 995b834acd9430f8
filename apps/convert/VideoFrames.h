// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>

#include <string>

namespace pointplane
{
/** Frames of a video, one after the other. */
class VideoFrames
{
 public:
    /** \throws InputError naming the file, with advice */
    explicit VideoFrames(const std::string& path);

    /** Frame `key`, counted from 0, later than the one before. \throws BadFrame if there is none */
    [[nodiscard]] cv::Mat frame(long key);

 private:
    std::string path_;
    cv::VideoCapture capture_;
    long next_{0};
};
}  // namespace pointplane
