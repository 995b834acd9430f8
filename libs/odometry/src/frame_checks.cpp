// SPDX-License-Identifier: BSD-3-Clause
#include "frame_checks.h"

#include <opencv2/core.hpp>

#include <cmath>
#include <sstream>

namespace pointplane
{
bool sameCamera(const PinholeCamera& a, const PinholeCamera& b)
{
    return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
           a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion;
}

std::string problemOf(const cv::Size& maskSize, const RgbdFrame& frame)
{
    if (maskSize.empty() || maskSize == frame.depth.size())
    {
        return "";
    }
    std::ostringstream out;
    out << "the mask (" << maskSize.width << "x" << maskSize.height
        << ") is not of the images' size (" << frame.depth.cols << "x" << frame.depth.rows << ")";
    return out.str();
}

std::string problemOf(const RgbdFrame& frame)
{
    if (std::string problem = frame.camera.problem(); !problem.empty())
    {
        return problem;
    }
    const cv::Size size(frame.camera.width, frame.camera.height);
    std::ostringstream out;
    if (!std::isfinite(frame.stamp))
    {
        out << "the time stamp is not finite";
    }
    else if (!frame.shutter.isPlausible())
    {
        out << "its shutter takes longer than a second";
    }
    else if (frame.depth.empty())
    {
        out << "there is no depth image";
    }
    else if (frame.depth.type() != CV_32FC1)
    {
        out << "the depth image is not CV_32FC1";
    }
    else if (!frame.gray.empty() && frame.gray.type() != CV_8UC1)
    {
        out << "the intensity image is not CV_8UC1";
    }
    else if (frame.depth.size() != size)
    {
        out << "the depth image (" << frame.depth.cols << "x" << frame.depth.rows
            << ") does not fit the camera (" << size.width << "x" << size.height << ")";
    }
    else if (!frame.gray.empty() && frame.gray.size() != size)
    {
        out << "the intensity image (" << frame.gray.cols << "x" << frame.gray.rows
            << ") does not fit the camera (" << size.width << "x" << size.height << ")";
    }
    return out.str();
}
}  // namespace pointplane
