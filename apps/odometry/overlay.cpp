// SPDX-License-Identifier: BSD-3-Clause
#include "overlay.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "overlay_legend.h"
#include "overlay_marks.h"

namespace pointplane
{
namespace
{
/** Part of a plane's colour in its pixels, the rest is the image's. */
constexpr double kTint = 0.45;

/** A camera that moves so fast has an arrow as long as half of the image's height [m/s]. */
constexpr double kFullSpeed = 1.0;

[[nodiscard]] double sigmaOfDistance(const PlaneFeature& plane)
{
    return std::sqrt(std::max(0.0, hessianCovariance(plane.plane_cam)(3, 3)));
}

[[nodiscard]] cv::Mat background(const cv::Mat& gray, const cv::Mat& depth, cv::Size size)
{
    cv::Mat picture;
    if (gray.empty() && depth.empty())
    {
        return {size, CV_8UC3, cv::Scalar()};
    }
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

/** The colour of a plane's pixel by the grey of the image. */
using Tints = std::array<cv::Vec3b, 256>;

[[nodiscard]] Tints tintsOf(const cv::Vec3b& colour)
{
    Tints out;
    for (std::size_t grey = 0; grey < out.size(); ++grey)
    {
        for (int c = 0; c < 3; ++c)
        {
            out[grey][c] = static_cast<std::uint8_t>(
                (1 - kTint) * static_cast<double>(grey) + kTint * colour[c]);
        }
    }
    return out;
}

/** Fills the planes that the pose follows, or that are new, and outlines all. \param picture grey
 */
void drawPlanes(const FrameFeatures& features, cv::Mat& picture)
{
    const cv::Mat& labels = features.planes.labels;
    if (labels.size() != picture.size())
    {
        return;
    }
    const std::size_t numPlanes = std::min<std::size_t>(255, features.planes.planes.size());
    std::array<cv::Vec3b, 256> colours{};
    std::vector<Tints> tints(numPlanes + 1);
    std::array<bool, 256> filled{};
    for (std::size_t i = 0; i < numPlanes; ++i)
    {
        colours[i + 1] = sigmaColour(sigmaOfDistance(features.planes.planes[i]));
        tints[i + 1] = tintsOf(colours[i + 1]);
        filled[i + 1] = features.planeUses[i] != FeatureUse::Rejected;
    }
    for (int v = 0; v < labels.rows; ++v)
    {
        const auto* label = labels.ptr<std::uint8_t>(v);
        const auto* above = labels.ptr<std::uint8_t>(std::max(v - 1, 0));
        const auto* below = labels.ptr<std::uint8_t>(std::min(v + 1, labels.rows - 1));
        auto* pixel = picture.ptr<cv::Vec3b>(v);
        for (int u = 0; u < labels.cols; ++u)
        {
            const std::uint8_t here = label[u], left = label[std::max(u - 1, 0)],
                               right = label[std::min(u + 1, labels.cols - 1)];
            if (here != left || here != right || here != above[u] || here != below[u])
            {
                pixel[u] = colours[here != 0 ? here : std::max({left, right, above[u], below[u]})];
            }
            else if (here != 0 && filled[here])
            {
                pixel[u] = tints[here][pixel[u][0]];
            }
        }
    }
}

/** Tints what has moved. */
void drawMoving(const MovingRegions& moving, cv::Mat& picture)
{
    for (const cv::Rect& cell : moving.cells)
    {
        cv::Mat pixels = picture(cell & cv::Rect({}, picture.size()));
        cv::Mat(pixels * (1 - kTint) + kTint * kMoving).copyTo(pixels);
    }
}

/** Where the camera moves, as seen in the image; its length is the speed. Thin: in part predicted.
 */
void drawArrow(const CameraSpeed& speed, bool isThin, cv::Mat& picture)
{
    const cv::Point2d centre(0.5 * picture.cols, 0.5 * picture.rows);
    const double scale = 0.5 * picture.rows / kFullSpeed;
    const cv::Point2d tip =
        centre + scale * cv::Point2d(speed.translation.x(), speed.translation.y());
    cv::circle(picture, centre, 2, kArrow, cv::FILLED, cv::LINE_AA);
    cv::arrowedLine(picture, centre, tip, kArrow, isThin ? 1 : 2, cv::LINE_AA, 0, 0.2);
}
}  // namespace

cv::Mat drawOverlay(
    const OutputItem& item, double seconds, const std::optional<CameraSpeed>& speed, cv::Size size)
{
    const RgbdFrame& frame = item.source.converted->frame;
    const FrameRecord& record = *item.frame;
    cv::Mat picture = background(frame.gray, frame.depth, size);
    drawPlanes(record.features, picture);
    drawMoving(record.features.moving, picture);
    for (const FrameFeatures::Point& point : record.features.points)
    {
        drawPoint(point.use, {point.uv_px.x(), point.uv_px.y()}, picture);
    }
    if (speed)
    {
        drawArrow(*speed, isInPart(record.motion), picture);
    }
    if (record.features.isKeyframe)
    {
        cv::rectangle(picture, cv::Rect({}, picture.size()), kArrow, 2);
    }
    const cv::Mat legend =
        overlayLegend(picture.cols, record, item.source.frameIndex, seconds, speed);
    cv::vconcat(picture, legend, picture);
    return picture;
}
}  // namespace pointplane
