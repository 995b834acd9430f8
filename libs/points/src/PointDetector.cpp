// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/range.h>
#include <pointplane/points/PointDetector.h>

#include <opencv2/features2d.hpp>
#ifdef POINTPLANE_HAVE_XFEATURES2D
#include <opencv2/xfeatures2d/nonfree.hpp>
#endif

#include <algorithm>

#include "dlib_surf.h"
#include "fast_corners.h"
#include "spread.h"

namespace pointplane
{
namespace
{
using KeyPoints = std::vector<cv::KeyPoint>;

constexpr int kOrbBorderPx = 31;  // OpenCV's ORB drops points nearer to the border

/** OpenCV's SURF [P17, section Point Extraction], or null where OpenCV was built without it. */
cv::Ptr<cv::Feature2D> openCvSurf([[maybe_unused]] const PointDetector::TParams& params)
{
#ifdef POINTPLANE_HAVE_XFEATURES2D
    try
    {
        // OpenCV's determinant is normalised by the area: 30 of dlib's are about 400 of its.
        return cv::xfeatures2d::SURF::create(
            params.surfThreshold * 400 / 30, 4, 3, false, params.upright);
    }
    catch (const cv::Exception&)
    {
        return {};  // present, but compiled without the non-free part
    }
#else
    return {};
#endif
}

/** OpenCV's extractor that detects and describes in one go, or null. */
cv::Ptr<cv::Feature2D> makeExtractor(const PointDetector::TParams& params)
{
    if (params.detector == "akaze")
    {
        return cv::AKAZE::create(
            cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, static_cast<float>(params.akazeThreshold));
    }
    if (params.detector == "sift")
    {
        // Twice as many as kept, for an even spread.
        return cv::SIFT::create(2 * params.maxPoints, 3, params.siftThreshold);
    }
    return params.detector == "surf" ? openCvSurf(params) : nullptr;
}
}  // namespace

struct PointDetector::Impl
{
    TParams params;
    cv::Ptr<cv::Feature2D> extractor;  // akaze, sift, OpenCV's surf
    cv::Ptr<cv::ORB> orb;              // orb, and the descriptor of fast

    [[nodiscard]] KeyPoints selected(const KeyPoints& points, cv::Size size) const
    {
        KeyPoints out;
        for (const int i : selectSpread(points, size, params.gridCellPx, params.maxPoints))
        {
            out.push_back(points[static_cast<size_t>(i)]);
        }
        return out;
    }

    /** dlib's SURF [P17, section Point Extraction]. */
    KeyPoints surf(const cv::Mat& gray, cv::Mat& descriptors) const
    {
        const DlibSurf surf(gray);
        KeyPoints points = selected(surf.detect(params.surfThreshold), gray.size());
        descriptors = surf.describe(points, params.upright);
        return points;
    }

    KeyPoints fast(const cv::Mat& gray, cv::Mat& descriptors) const
    {
        KeyPoints points = selected(
            fastCorners(gray, params.fastThreshold, params.gridCellPx, kOrbBorderPx), gray.size());
        refineCorners(gray, points);
        for (cv::KeyPoint& point : points)
        {
            point.angle = 0;  // upright: more distinctive while the camera rolls little
            point.octave = 0;
        }
        orb->compute(gray, points, descriptors);
        return points;
    }

    KeyPoints orbPoints(const cv::Mat& gray, cv::Mat& descriptors) const
    {
        KeyPoints points;
        orb->detect(gray, points);
        points = selected(points, gray.size());
        orb->compute(gray, points, descriptors);
        return points;
    }

    KeyPoints extract(const cv::Mat& gray, cv::Mat& descriptors) const
    {
        KeyPoints all;
        cv::Mat allDescriptors;
        extractor->detectAndCompute(gray, {}, all, allDescriptors);
        for (size_t i = 0; i < all.size(); ++i)
        {
            all[i].class_id = static_cast<int>(i);  // finds the descriptor after the selection
        }
        const KeyPoints points = selected(all, gray.size());
        descriptors.create(
            static_cast<int>(points.size()), allDescriptors.cols, allDescriptors.type());
        for (size_t i = 0; i < points.size(); ++i)
        {
            allDescriptors.row(points[i].class_id).copyTo(descriptors.row(static_cast<int>(i)));
        }
        return points;
    }
};

void PointDetector::TParams::check() const
{
    const std::vector<std::string> known{"surf", "orb", "akaze", "sift", "fast"};
    POINTPLANE_CHECK(
        std::find(known.begin(), known.end(), detector) != known.end(),
        "detector = " << detector << " is not surf, orb, akaze, sift or fast");
    checkRange("maxPoints", maxPoints, 1, 100000);
    checkRange("gridCellPx", gridCellPx, 1, 10000);
    checkRange("surfThreshold", surfThreshold, 1e-3, 1e6);
    checkRange("fastThreshold", fastThreshold, 1, 254);
    checkRange("akazeThreshold", akazeThreshold, 1e-9, 1);
    checkRange("siftThreshold", siftThreshold, 1e-6, 1);
}

PointDetector::PointDetector(const TParams& params) : impl_(std::make_unique<Impl>())
{
    params.check();
    impl_->params = params;
    impl_->extractor = makeExtractor(params);
    // Many more than are kept, for an even spread.
    impl_->orb = cv::ORB::create(4 * params.maxPoints);
    impl_->orb->setFastThreshold(params.fastThreshold);
}
PointDetector::~PointDetector() = default;
PointDetector::PointDetector(PointDetector&&) noexcept = default;
PointDetector& PointDetector::operator=(PointDetector&&) noexcept = default;

DetectedPoints PointDetector::detect(const cv::Mat& gray) const
{
    DetectedPoints out;
    if (std::min(gray.cols, gray.rows) < 2)
    {
        return out;  // no image, or one that has no half: OpenCV's pyramids throw
    }
    POINTPLANE_CHECK(gray.type() == CV_8UC1, "key points need an 8-bit gray image");

    const std::string& detector = impl_->params.detector;
    const KeyPoints points = impl_->extractor     ? impl_->extract(gray, out.descriptors)
                             : detector == "surf" ? impl_->surf(gray, out.descriptors)
                             : detector == "orb"  ? impl_->orbPoints(gray, out.descriptors)
                                                  : impl_->fast(gray, out.descriptors);
    out.uv_px.reserve(points.size());
    for (const cv::KeyPoint& point : points)
    {
        out.uv_px.emplace_back(point.pt.x, point.pt.y);
    }
    return out;
}
}  // namespace pointplane
