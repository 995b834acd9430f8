// SPDX-License-Identifier: BSD-3-Clause
#include "overlay_marks.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace pointplane
{
const cv::Mat& colourMap()
{
    static const cv::Mat map = []
    {
        cv::Mat levels(1, 256, CV_8UC1), out;
        for (int i = 0; i < 256; ++i)
        {
            levels.at<std::uint8_t>(0, i) = static_cast<std::uint8_t>(i);
        }
        cv::applyColorMap(levels, out, cv::COLORMAP_JET);
        return out;
    }();
    return map;
}

cv::Vec3b sigmaColour(double sigma)
{
    const double level = std::log(std::clamp(sigma, kSmallSigma, kLargeSigma) / kSmallSigma) /
                         std::log(kLargeSigma / kSmallSigma);
    return colourMap().at<cv::Vec3b>(0, static_cast<int>(std::lround(255 * level)));
}

void drawPoint(FeatureUse use, const cv::Point2d& at, cv::Mat& picture)
{
    const cv::Point centre(cvRound(at.x), cvRound(at.y));
    // Shapes differ, too: green, orange and red are much alike for people with colour-blindness.
    if (use == FeatureUse::Used)
    {
        cv::circle(picture, centre, 3, kUsed, 1);
    }
    else if (use == FeatureUse::Doubted)
    {
        cv::drawMarker(picture, centre, kDoubted, cv::MARKER_TRIANGLE_UP, 8, 1);
    }
    else if (use == FeatureUse::Rejected)
    {
        cv::drawMarker(picture, centre, kRejected, cv::MARKER_TILTED_CROSS, 7, 1);
    }
    else
    {
        cv::circle(picture, centre, 1, kNew, cv::FILLED);
    }
}
}  // namespace pointplane
