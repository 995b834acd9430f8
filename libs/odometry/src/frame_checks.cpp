// SPDX-License-Identifier: BSD-3-Clause
#include "frame_checks.h"

#include <pointplane/core/latest_stamp.h>
#include <pointplane/core/number_text.h>

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace pointplane
{
bool sameCamera(const PinholeCamera& a, const PinholeCamera& b)
{
    return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
           a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion;
}

bool isTime(double stamp)
{
    return std::abs(stamp) <= static_cast<double>(kLatestStamp);  // false for NaN
}

std::string problemOf(const RgbdFrame& frame, const cv::Size& maskSize)
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
    else if (!isTime(frame.stamp))
    {
        out << "its time stamp, " << numberText(frame.stamp)
            << ", is too large for seconds; divide milliseconds by 1e3, nanoseconds by 1e9";
    }
    else if (!frame.shutter.isPlausible())
    {
        out << "its shutter takes longer than a second";
    }
    else if (frame.depth.empty())
    {
        out << "there is no depth image";
    }
    else if (frame.depth.type() != CV_32FC1 || frame.depth.dims != 2)
    {
        out << "the depth image is not CV_32FC1";
    }
    else if (!frame.gray.empty() && (frame.gray.type() != CV_8UC1 || frame.gray.dims != 2))
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
    else if (!maskSize.empty() && maskSize != size)
    {
        out << "the mask (" << maskSize.width << "x" << maskSize.height
            << ") is not of the images' size (" << size.width << "x" << size.height << ")";
    }
    return out.str();
}

std::string whyNoDepth(const cv::Mat& depth, const PointLifter::TParams& range)
{
    const auto least = static_cast<float>(range.minDepth);
    const auto most = static_cast<float>(range.maxDepth);
    const cv::Mat readings = (depth > 0) & (depth <= std::numeric_limits<float>::max());
    const double numReadings = cv::countNonZero(readings);
    const double numNear = cv::countNonZero(readings & (depth < least));
    const double numFar = cv::countNonZero(readings & (depth > most));
    const double needed = kLeastDepthShare * static_cast<double>(depth.total());
    const auto percent = [&](double count)
    { return 100 * count / static_cast<double>(depth.total()); };
    std::ostringstream out;
    out.precision(2);
    if (numReadings == 0)
    {
        out << "its depth image has no reading";
    }
    else if (numReadings < needed)
    {
        out << "its depth image has readings in only " << percent(numReadings)
            << " % of its pixels";
    }
    else if (numReadings - numNear - numFar < needed)
    {
        const bool areNear = numNear > numFar;
        out.precision(3);
        out << percent(std::max(numNear, numFar)) << " % of its depth pixels are "
            << (areNear ? "nearer than PointLifter.minDepth ("
                        : "farther than PointLifter.maxDepth (")
            << (areNear ? range.minDepth : range.maxDepth) << " m)";
    }
    return out.str();
}

std::string whyNoPoint(const cv::Mat& gray)
{
    cv::Scalar mean, deviation;
    cv::meanStdDev(gray, mean, deviation);
    std::ostringstream out;
    out << "no point is found in its colour image (mean grey " << std::lround(mean[0])
        << " of 255, standard deviation " << std::lround(deviation[0]) << ")";
    return out.str();
}
}  // namespace pointplane
