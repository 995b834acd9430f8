// SPDX-License-Identifier: BSD-3-Clause
#include "overlay.h"

#include <pointplane/mrpt_io/errors.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

namespace pointplane
{
namespace
{
// Ends of the colour scale for the standard deviation of a plane's distance [m].
constexpr double kSmallSigma = 1e-4;
constexpr double kLargeSigma = 1e-1;

/** Blue to red on a logarithmic scale. */
[[nodiscard]] cv::Scalar sigmaColour(double sigma)
{
    const double level = std::log(std::clamp(sigma, kSmallSigma, kLargeSigma) / kSmallSigma) /
                         std::log(kLargeSigma / kSmallSigma);
    cv::Mat index(1, 1, CV_8UC1, cv::Scalar(std::round(255 * level)));
    cv::Mat colour;
    cv::applyColorMap(index, colour, cv::COLORMAP_JET);
    const auto bgr = colour.at<cv::Vec3b>(0, 0);
    return {double(bgr[0]), double(bgr[1]), double(bgr[2])};
}

[[nodiscard]] double sigmaOfDistance(const PlaneFeature& plane)
{
    return std::sqrt(std::max(0.0, hessianCovariance(plane.plane_cam)(3, 3)));
}

[[nodiscard]] cv::Mat background(const cv::Mat& gray, const cv::Mat& depth)
{
    cv::Mat picture;
    if (!gray.empty())
    {
        cv::cvtColor(gray, picture, cv::COLOR_GRAY2BGR);
        return picture;
    }
    cv::Mat inverse = cv::Mat::zeros(depth.size(), CV_8UC1);
    for (int v = 0; v < depth.rows; ++v)
    {
        for (int u = 0; u < depth.cols; ++u)
        {
            const float z = depth.at<float>(v, u);
            inverse.at<std::uint8_t>(v, u) =
                z > 0 ? cv::saturate_cast<std::uint8_t>(128.0F / z) : std::uint8_t{0};
        }
    }
    cv::cvtColor(inverse, picture, cv::COLOR_GRAY2BGR);
    return picture;
}

void tintPlanes(const PlaneSet& planes, cv::Mat& picture)
{
    if (planes.labels.size() != picture.size())
    {
        return;
    }
    for (std::size_t i = 0; i < planes.planes.size(); ++i)
    {
        const cv::Mat mask = planes.labels == static_cast<int>(i) + 1;
        const cv::Scalar colour = sigmaColour(sigmaOfDistance(planes.planes[i]));
        cv::Mat tinted = picture.clone();
        tinted.setTo(colour, mask);
        cv::addWeighted(picture, 0.55, tinted, 0.45, 0, picture);
        std::vector<std::vector<cv::Point>> outlines;
        cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
        cv::drawContours(picture, outlines, -1, colour, 1, cv::LINE_AA);
    }
}
}  // namespace

cv::Mat drawOverlay(
    const cv::Mat& gray, const cv::Mat& depth, const FrameRecord& record, std::size_t frameIndex)
{
    cv::Mat picture = gray.empty() && depth.empty() ? cv::Mat(480, 640, CV_8UC3, cv::Scalar())
                                                    : background(gray, depth);
    tintPlanes(record.features.planes, picture);
    for (const PointFeature& point : record.features.points)
    {
        const cv::Point2d centre(point.uv_px.x(), point.uv_px.y());
        cv::circle(picture, centre, 3, cv::Scalar(80, 255, 80), 1, cv::LINE_AA);
    }
    char text[160];
    std::snprintf(
        text,
        sizeof(text),
        "frame %zu  %s  %zu points  %zu planes  colour: sigma_d %.1f mm (blue) to %.0f mm (red)",
        frameIndex,
        toString(record.motion.status),
        record.features.points.size(),
        record.features.planes.planes.size(),
        1e3 * kSmallSigma,
        1e3 * kLargeSigma);
    cv::rectangle(picture, cv::Rect(0, 0, picture.cols, 16), cv::Scalar(), cv::FILLED);
    cv::putText(
        picture,
        text,
        {4, 12},
        cv::FONT_HERSHEY_SIMPLEX,
        0.38,
        cv::Scalar(255, 255, 255),
        1,
        cv::LINE_AA);
    return picture;
}

OverlaySink::OverlaySink(const std::string& folder) : folder_(folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
    {
        throw EnvironmentError("cannot create " + folder + ": " + error.message());
    }
}

void OverlaySink::add(const OutputItem& item)
{
    if (!item.frame)
    {
        return;
    }
    const RgbdFrame& frame = item.source.converted->frame;
    char name[32];
    std::snprintf(name, sizeof(name), "/%06zu.png", item.source.frameIndex);
    const std::string path = folder_ + name;
    const cv::Mat picture =
        drawOverlay(frame.gray, frame.depth, *item.frame, item.source.frameIndex);
    if (!cv::imwrite(path, picture, {cv::IMWRITE_PNG_COMPRESSION, 1}))
    {
        throw EnvironmentError("cannot write " + path);
    }
    ++numPictures_;
}

std::string OverlaySink::description() const
{
    return folder_ + ": " + std::to_string(numPictures_) + " pictures";
}
}  // namespace pointplane
