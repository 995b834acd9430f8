// SPDX-License-Identifier: BSD-3-Clause
#include "dlib_surf.h"

// dlib's headers alone do; without its BLAS bindings, a burden for vectors of 64 numbers, there is
// no library to link. assert.h is guarded and defines the bindings, hence the order. The check that
// headers and library fit together, which needs that library, counts as included: only optimised
// builds would drop it.
#define DLIB_TEST_FOR_ODR_VIOLATIONS_H_
#include <dlib/assert.h>
#undef DLIB_USE_BLAS
#undef DLIB_USE_LAPACK
#include <opencv2/imgproc.hpp>

#include <dlib/image_keypoint/surf.h>

namespace pointplane
{
namespace
{
constexpr double kSizeOverScale = 20;
constexpr double kBorderOverScale =
    32;  // dlib's descriptor looks this far, rotated corners included
constexpr long kOctaves = 4, kIntervals = 6, kInitialStep = 2;  // as dlib::get_surf_points
}  // namespace

/** What dlib's templates ask of an integral image, on OpenCV's fast one. */
struct DlibSurf::IntegralImage
{
    using value_type = int;

    explicit IntegralImage(const cv::Mat& gray) { cv::integral(gray, sums, CV_32S); }

    [[nodiscard]] long nr() const { return sums.rows - 1; }
    [[nodiscard]] long nc() const { return sums.cols - 1; }
    [[nodiscard]] int get_sum_of_area(const dlib::rectangle& r) const
    {
        // Modulo 2^32: the sums of large images overflow, those of areas do not.
        const auto* top = sums.ptr<unsigned>(static_cast<int>(r.top()));
        const auto* bottom = sums.ptr<unsigned>(static_cast<int>(r.bottom() + 1));
        return static_cast<int>(
            bottom[r.right() + 1] - bottom[r.left()] - top[r.right() + 1] + top[r.left()]);
    }

    cv::Mat sums;
};

DlibSurf::DlibSurf(const cv::Mat& gray) : integral_(std::make_unique<IntegralImage>(gray)) {}
DlibSurf::~DlibSurf() = default;

std::vector<cv::KeyPoint> DlibSurf::detect(double threshold) const
{
    dlib::hessian_pyramid pyramid;
    pyramid.build_pyramid(*integral_, kOctaves, kIntervals, kInitialStep);
    std::vector<dlib::interest_point> points;
    dlib::get_interest_points(pyramid, threshold, points);

    const dlib::rectangle image = dlib::get_rect(*integral_);
    std::vector<cv::KeyPoint> out;
    out.reserve(points.size());
    for (const dlib::interest_point& p : points)
    {
        const auto border = static_cast<unsigned long>(kBorderOverScale * p.scale);
        if (image.contains(dlib::centered_rect(p.center, border, border)))
        {
            out.emplace_back(
                static_cast<float>(p.center.x()),
                static_cast<float>(p.center.y()),
                static_cast<float>(kSizeOverScale * p.scale),
                -1.0F,
                static_cast<float>(p.score));
        }
    }
    return out;
}

cv::Mat DlibSurf::describe(const std::vector<cv::KeyPoint>& points, bool upright) const
{
    cv::Mat out(static_cast<int>(points.size()), 64, CV_32FC1);
    cv::parallel_for_(
        cv::Range(0, out.rows),
        [&](const cv::Range& range)
        {
            dlib::matrix<double, 64, 1> descriptor;
            for (int i = range.start; i < range.end; ++i)
            {
                const cv::KeyPoint& point = points[static_cast<size_t>(i)];
                const dlib::vector<double, 2> centre(
                    static_cast<double>(point.pt.x), static_cast<double>(point.pt.y));
                const double scale = static_cast<double>(point.size) / kSizeOverScale;
                const double angle =
                    upright ? 0.0 : dlib::compute_dominant_angle(*integral_, centre, scale);
                dlib::compute_surf_descriptor(*integral_, centre, scale, angle, descriptor);
                for (int k = 0; k < 64; ++k)
                {
                    out.at<float>(i, k) = static_cast<float>(descriptor(k));
                }
            }
        });
    return out;
}
}  // namespace pointplane
