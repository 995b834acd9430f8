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
        const cv::Vec3d pale(255, 235, 170), dark(190, 0, 0);
        cv::Mat out(1, 256, CV_8UC3);
        for (int i = 0; i < 256; ++i)
        {
            out.at<cv::Vec3b>(0, i) = pale + i / 255.0 * (dark - pale);
        }
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
    for (const bool isHalo : {true, false})
    {
        const int thickness = isHalo ? 3 : 1;
        const auto colour = [isHalo](const cv::Scalar& c) { return isHalo ? cv::Scalar() : c; };
        // Shapes differ, too: green, orange and red are much alike for people with
        // colour-blindness.
        if (use == FeatureUse::Used)
        {
            cv::circle(picture, centre, isHalo ? 4 : 3, colour(kUsed), 1);
        }
        else if (use == FeatureUse::Doubted)
        {
            cv::drawMarker(picture, centre, colour(kDoubted), cv::MARKER_TRIANGLE_UP, 8, thickness);
        }
        else if (use == FeatureUse::Rejected)
        {
            cv::drawMarker(
                picture, centre, colour(kRejected), cv::MARKER_TILTED_CROSS, 7, thickness);
        }
        else
        {
            cv::circle(picture, centre, isHalo ? 2 : 1, colour(kNew), cv::FILLED);
        }
    }
}
}  // namespace pointplane
