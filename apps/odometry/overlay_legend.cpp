// SPDX-License-Identifier: BSD-3-Clause
#include "overlay_legend.h"

#include <pointplane/core/counted.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "overlay_marks.h"

namespace pointplane
{
namespace
{
/** Lines of text below a picture, broken where it ends. */
class Legend
{
 public:
    explicit Legend(int width) : strip_(2 * kLine, std::max(1, width), CV_8UC3, cv::Scalar()) {}

    /** \param width kept for it, so that the legends of all frames look alike [px] */
    void add(const std::string& text, int width, const cv::Scalar& colour = kText)
    {
        width = widthOf(text, 0, width);
        make(width);
        put(text, x_, colour);
        x_ += width;
    }

    void addPoint(FeatureUse use, const std::string& text)
    {
        constexpr int kMark = 13;
        const int width = widthOf(text, kMark, kPoint);
        make(width);
        drawPoint(use, cv::Point2d(x_ + 5.0, y_ + 0.5 * kLine), strip_);
        put(text, x_ + kMark, kText);
        x_ += width;
    }

    void endLine() { x_ = strip_.cols; }

    /** The scale of the planes' colours, in one line if the width allows. */
    void addColours()
    {
        constexpr int kName = 104, kSmall = 31, kBar = 110, kLarge = 67;
        make(kName + kSmall + kBar + kLarge);
        add("plane: 1 sigma", kName);
        char small[32], large[32];
        std::snprintf(small, sizeof(small), "%.1f", 1e3 * kSmallSigma);
        std::snprintf(large, sizeof(large), "%.0f mm", 1e3 * kLargeSigma);
        make(kSmall + kBar + kLarge);
        add(small, kSmall);
        const cv::Rect bar = cv::Rect(x_, y_ + 4, kBar, kLine - 8) & cv::Rect({}, strip_.size());
        if (!bar.empty())
        {
            cv::Mat colours;
            cv::resize(colourMap(), colours, {kBar, bar.height});
            colours.colRange(0, bar.width).copyTo(strip_(bar));
        }
        x_ += kBar + 4;
        add(large, 0);
    }

    [[nodiscard]] const cv::Mat& strip() const { return strip_; }

 private:
    static constexpr int kLine = 18, kPoint = 110, kFont = cv::FONT_HERSHEY_SIMPLEX;
    static constexpr double kFontScale = 0.4;

    /** What is kept for a text, or what it takes. */
    [[nodiscard]] static int widthOf(const std::string& text, int indent, int kept)
    {
        constexpr int kGap = 8;
        const cv::Size size = cv::getTextSize(text, kFont, kFontScale, 1, nullptr);
        return std::max(kept, text.empty() ? 0 : indent + size.width + kGap);
    }

    void put(const std::string& text, int x, const cv::Scalar& colour)
    {
        const cv::Point at(x, y_ + kLine - 5);
        cv::putText(strip_, text, at, kFont, kFontScale, colour, 1, cv::LINE_AA);
    }

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

/** In parts where the picture is too narrow for the whole. */
void addSpeed(const std::optional<CameraSpeed>& speed, Legend& legend)
{
    constexpr int kWhole = 280;
    char size[32] = "-> not measured", forward[32] = "", rotation[32] = "";
    if (speed)
    {
        std::snprintf(size, sizeof(size), "-> %.2f m/s", speed->translation.norm());
        std::snprintf(forward, sizeof(forward), "(%+.2f forward),", speed->translation.z());
        std::snprintf(rotation, sizeof(rotation), "%.0f deg/s", speed->rotation * 180 / M_PI);
    }
    if (legend.strip().cols >= kWhole)
    {
        legend.add(std::string(size) + " " + forward + " " + rotation, kWhole, kArrow);
        return;
    }
    for (const char* part : {size, forward, rotation})
    {
        legend.add(part, 112, kArrow);
    }
}

void addStatus(
    const FrameRecord& record,
    std::size_t frameIndex,
    double seconds,
    const std::optional<CameraSpeed>& speed,
    Legend& legend)
{
    char text[64];
    const bool isKey = record.features.isKeyframe;
    std::snprintf(text, sizeof(text), "%s %zu", isKey ? "KEY FRAME" : "frame", frameIndex);
    legend.add(text, 120, isKey ? kArrow : kText);
    std::snprintf(text, sizeof(text), "%.3f s", seconds);
    legend.add(std::isfinite(seconds) ? text : "", 76);
    const RobotMotion& motion = record.motion;
    std::string status = toString(motion.status);
    if (isInPart(motion))
    {
        status += ", " + std::to_string(motion.diagnostics.observableDirections) + " of 6";
    }
    legend.add(
        status,
        108,
        isInPart(motion)            ? kDoubted
        : isMeasured(motion.status) ? kUsed
                                    : kRejected);
    addSpeed(speed, legend);
}

void addCounts(const FrameFeatures& features, Legend& legend)
{
    const auto count = [&](FeatureUse use)
    {
        return static_cast<std::size_t>(std::count_if(
            features.points.begin(),
            features.points.end(),
            [&](const FrameFeatures::Point& p) { return p.use == use; }));
    };
    const auto addPoints = [&](FeatureUse use, const char* what)
    { legend.addPoint(use, std::to_string(count(use)) + " " + what); };
    addPoints(FeatureUse::Used, "used");
    addPoints(FeatureUse::Doubted, "doubted");
    addPoints(FeatureUse::Rejected, "rejected");
    legend.addPoint(FeatureUse::New, counted(count(FeatureUse::New), "new point"));
    const auto numPlanes =
        std::count(features.planeUses.begin(), features.planeUses.end(), FeatureUse::Used);
    legend.add(
        std::to_string(numPlanes) + " of " + counted(features.planeUses.size(), "plane") + " used",
        150);
    char text[64];
    std::snprintf(text, sizeof(text), "%.0f %% moving", 100 * features.moving.share());
    legend.add(text, 90, kMoving);
}
}  // namespace

cv::Mat overlayLegend(
    int width,
    const FrameRecord& record,
    std::size_t frameIndex,
    double seconds,
    const std::optional<CameraSpeed>& speed)
{
    Legend legend(width);
    addStatus(record, frameIndex, seconds, speed, legend);
    legend.endLine();
    addCounts(record.features, legend);
    legend.addColours();
    return legend.strip();
}
}  // namespace pointplane
