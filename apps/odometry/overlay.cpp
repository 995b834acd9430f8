// SPDX-License-Identifier: BSD-3-Clause
#include "overlay.h"

#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/image_file.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
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

/** Part of a plane's colour in its pixels, the rest is the image's. */
constexpr double kTint = 0.45;

/** A camera that moves so fast has an arrow as long as half of the image's height [m/s]. */
constexpr double kFullSpeed = 1.0;

const cv::Scalar kUsed{80, 255, 80}, kDoubted{0, 200, 255}, kRejected{60, 60, 255};
const cv::Scalar kNew{255, 255, 255}, kMoving{255, 0, 255};
const cv::Scalar kText{255, 255, 255}, kArrow{0, 220, 255};

/** Blue to red, level 0 to 255. */
[[nodiscard]] const cv::Mat& colourMap()
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

/** On a logarithmic scale. */
[[nodiscard]] cv::Vec3b sigmaColour(double sigma)
{
    const double level = std::log(std::clamp(sigma, kSmallSigma, kLargeSigma) / kSmallSigma) /
                         std::log(kLargeSigma / kSmallSigma);
    return colourMap().at<cv::Vec3b>(0, static_cast<int>(std::lround(255 * level)));
}

[[nodiscard]] double sigmaOfDistance(const PlaneFeature& plane)
{
    return std::sqrt(std::max(0.0, hessianCovariance(plane.plane_cam)(3, 3)));
}

[[nodiscard]] cv::Mat background(const cv::Mat& gray, const cv::Mat& depth)
{
    cv::Mat picture;
    if (gray.empty() && depth.empty())
    {
        return {480, 640, CV_8UC3, cv::Scalar()};
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

/** Fills the planes that the pose follows, or that are new, and outlines all. */
void drawPlanes(const FrameFeatures& features, cv::Mat& picture)
{
    const cv::Mat& labels = features.planes.labels;
    if (labels.size() != picture.size())
    {
        return;
    }
    std::array<cv::Vec3b, 256> colours{};
    std::array<bool, 256> filled{};
    for (std::size_t i = 0; i < std::min<std::size_t>(255, features.planes.planes.size()); ++i)
    {
        colours[i + 1] = sigmaColour(sigmaOfDistance(features.planes.planes[i]));
        filled[i + 1] = features.planeUses[i] != FeatureUse::Rejected;
    }
    for (int v = 0; v < labels.rows; ++v)
    {
        const auto* label = labels.ptr<std::uint8_t>(v);
        const auto* below = labels.ptr<std::uint8_t>(std::min(v + 1, labels.rows - 1));
        auto* pixel = picture.ptr<cv::Vec3b>(v);
        for (int u = 0; u < labels.cols; ++u)
        {
            const std::uint8_t here = label[u], right = label[std::min(u + 1, labels.cols - 1)];
            if (here != right || here != below[u])
            {
                pixel[u] = colours[here != 0 ? here : std::max(right, below[u])];
            }
            else if (here != 0 && filled[here])
            {
                for (int c = 0; c < 3; ++c)
                {
                    pixel[u][c] = static_cast<std::uint8_t>(
                        (1 - kTint) * pixel[u][c] + kTint * colours[here][c]);
                }
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

void drawPoint(FeatureUse use, const cv::Point2d& at, cv::Mat& picture)
{
    const cv::Point centre(cvRound(at.x), cvRound(at.y));
    if (use == FeatureUse::Used || use == FeatureUse::Doubted)
    {
        cv::circle(picture, centre, 3, use == FeatureUse::Used ? kUsed : kDoubted, 1);
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

/** Where the camera moves, as seen in the image; its length is the speed. */
void drawArrow(const CameraSpeed& speed, cv::Mat& picture)
{
    const cv::Point2d centre(0.5 * picture.cols, 0.5 * picture.rows);
    const double scale = 0.5 * picture.rows / kFullSpeed;
    const cv::Point2d tip =
        centre + scale * cv::Point2d(speed.translation.x(), speed.translation.y());
    cv::circle(picture, centre, 2, kArrow, cv::FILLED, cv::LINE_AA);
    cv::arrowedLine(picture, centre, tip, kArrow, 2, cv::LINE_AA, 0, 0.2);
}

/** Lines of text below a picture, broken where it ends. */
class Legend
{
 public:
    explicit Legend(int width) : strip_(2 * kLine, std::max(1, width), CV_8UC3, cv::Scalar()) {}

    /** \param width kept for it, so that the legends of all frames look alike [px] */
    void add(const std::string& text, int width, const cv::Scalar& colour = kText)
    {
        make(width);
        cv::putText(
            strip_,
            text,
            {x_, y_ + kLine - 5},
            cv::FONT_HERSHEY_SIMPLEX,
            0.4,
            colour,
            1,
            cv::LINE_AA);
        x_ += width;
    }

    void addPoint(FeatureUse use, int count, const char* what)
    {
        make(kPoint);
        drawPoint(use, cv::Point2d(x_ + 5.0, y_ + 0.5 * kLine), strip_);
        cv::putText(
            strip_,
            std::to_string(count) + " " + what,
            {x_ + 13, y_ + kLine - 5},
            cv::FONT_HERSHEY_SIMPLEX,
            0.4,
            kText,
            1,
            cv::LINE_AA);
        x_ += kPoint;
    }

    /** The scale of the planes' colours. */
    void addColours()
    {
        constexpr int kBar = 120;
        add("plane distance known to", 165);
        char small[32], large[32];
        std::snprintf(small, sizeof(small), "%.1f", 1e3 * kSmallSigma);
        std::snprintf(large, sizeof(large), "%.0f mm", 1e3 * kLargeSigma);
        make(24 + kBar + 60);
        add(small, 24);
        const cv::Rect bar = cv::Rect(x_, y_ + 4, kBar, kLine - 8) & cv::Rect({}, strip_.size());
        if (!bar.empty())
        {
            cv::Mat colours;
            cv::resize(colourMap(), colours, {kBar, bar.height});
            colours.colRange(0, bar.width).copyTo(strip_(bar));
        }
        x_ += kBar + 4;
        add(large, 56);
    }

    void appendTo(cv::Mat& picture) const { cv::vconcat(picture, strip_, picture); }

 private:
    static constexpr int kLine = 18, kPoint = 110;

    /** Room for an item in this line or a new one. */
    void make(int width)
    {
        if (x_ > kLeft && x_ + width > strip_.cols)
        {
            x_ = kLeft;
            y_ += kLine;
        }
        if (y_ + kLine > strip_.rows)
        {
            cv::copyMakeBorder(
                strip_, strip_, 0, y_ + kLine - strip_.rows, 0, 0, cv::BORDER_CONSTANT);
        }
    }

    static constexpr int kLeft = 4;
    cv::Mat strip_;
    int x_{kLeft}, y_{0};
};

void addStatus(
    const FrameRecord& record,
    std::size_t frameIndex,
    double seconds,
    const std::optional<CameraSpeed>& speed,
    Legend& legend)
{
    char text[64];
    std::snprintf(text, sizeof(text), "frame %zu", frameIndex);
    legend.add(text, 92);
    std::snprintf(text, sizeof(text), "%.3f s", seconds);
    legend.add(text, 82);
    const bool isMeasured = record.motion.status == TrackingStatus::Tracked ||
                            record.motion.status == TrackingStatus::First;
    legend.add(toString(record.motion.status), 72, isMeasured ? kUsed : kRejected);
    legend.add(record.features.isKeyframe ? "KEY FRAME" : "", 90, kArrow);
    if (speed)
    {
        std::snprintf(
            text,
            sizeof(text),
            "-> %.2f m/s (%+.2f forward), %.0f deg/s",
            speed->translation.norm(),
            speed->translation.z(),
            speed->rotation * 180 / M_PI);
    }
    legend.add(speed ? text : "", 290, kArrow);
}

void addCounts(const FrameFeatures& features, Legend& legend)
{
    const auto count = [&](FeatureUse use)
    {
        return static_cast<int>(std::count_if(
            features.points.begin(),
            features.points.end(),
            [&](const FrameFeatures::Point& p) { return p.use == use; }));
    };
    legend.addPoint(FeatureUse::Used, count(FeatureUse::Used), "used");
    legend.addPoint(FeatureUse::Doubted, count(FeatureUse::Doubted), "doubted");
    legend.addPoint(FeatureUse::Rejected, count(FeatureUse::Rejected), "rejected");
    legend.addPoint(FeatureUse::New, count(FeatureUse::New), "new points");
    char text[64];
    std::snprintf(
        text,
        sizeof(text),
        "%d of %zu planes used",
        static_cast<int>(
            std::count(features.planeUses.begin(), features.planeUses.end(), FeatureUse::Used)),
        features.planeUses.size());
    legend.add(text, 150);
    std::snprintf(text, sizeof(text), "%.0f %% moving", 100 * features.moving.share());
    legend.add(text, 90, kMoving);
}
}  // namespace

cv::Mat drawOverlay(
    const cv::Mat& gray,
    const cv::Mat& depth,
    const FrameRecord& record,
    std::size_t frameIndex,
    double seconds,
    const std::optional<CameraSpeed>& speed)
{
    cv::Mat picture = background(gray, depth);
    drawPlanes(record.features, picture);
    drawMoving(record.features.moving, picture);
    for (const FrameFeatures::Point& point : record.features.points)
    {
        drawPoint(point.use, {point.uv_px.x(), point.uv_px.y()}, picture);
    }
    if (speed)
    {
        drawArrow(*speed, picture);
    }
    if (record.features.isKeyframe)
    {
        cv::rectangle(picture, cv::Rect({}, picture.size()), kArrow, 2);
    }
    Legend legend(picture.cols);
    addStatus(record, frameIndex, seconds, speed, legend);
    addCounts(record.features, legend);
    legend.addColours();
    legend.appendTo(picture);
    return picture;
}

OverlaySink::OverlaySink(const std::string& folder, std::size_t every)
    : folder_(folder), every_(every)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
    {
        throw EnvironmentError("cannot create " + folder + ": " + error.message());
    }
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
    const RgbdFrame& frame = item.source.converted->frame;
    const auto speed = speedAt(item);
    firstStamp_ = firstStamp_.value_or(frame.stamp);
    if (numFrames_++ % every_ != 0)
    {
        return;
    }
    char name[32];
    std::snprintf(name, sizeof(name), "/%06zu.jpg", item.source.frameIndex);
    const std::string path = folder_ + name;
    const cv::Mat picture = drawOverlay(
        frame.gray,
        frame.depth,
        *item.frame,
        item.source.frameIndex,
        frame.stamp - *firstStamp_,
        speed);
    writeImageFile(path, picture, {cv::IMWRITE_JPEG_QUALITY, 90});
    ++numPictures_;
}

std::string OverlaySink::description() const
{
    return folder_ + ": " + std::to_string(numPictures_) + " pictures";
}
}  // namespace pointplane
