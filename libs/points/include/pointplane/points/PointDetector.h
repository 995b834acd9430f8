// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

#include <opencv2/core/mat.hpp>

#include <memory>
#include <string>
#include <vector>

namespace pointplane
{
/** Key points of one image. Row i of the descriptors belongs to uv_px[i]. */
struct DetectedPoints
{
    std::vector<Eigen::Vector2d> uv_px;  //!< raw pixels, sub-pixel accurate
    cv::Mat descriptors;                 //!< CV_32FC1 (compare by L2) or CV_8UC1 (by Hamming)
};

/** Finds key points with descriptors, spread evenly over the image. The same image gives the same
 * points, whatever the number of threads. */
class PointDetector
{
 public:
    struct TParams
    {
        std::string detector{"surf"};  //!< surf | orb | akaze | sift | fast
        int maxPoints{500};            //!< the strongest of each grid cell are kept
        int gridCellPx{40};            //!< side of the cells
        double surfThreshold{30};      //!< least determinant of the Hessian
        bool upright{true};            //!< SURF without orientation
        int fastThreshold{15};         //!< least contrast of a corner (fast and orb)
        double akazeThreshold{0.001};  //!< least response (akaze)
        double siftThreshold{0.04};    //!< least contrast (sift)

        template <class V>
        void visit(V&& v)
        {
            v("detector",
              detector,
              "-",
              "with method = match: surf, orb, akaze, sift, or fast (FAST corners with ORB "
              "descriptors)");
            v("maxPoints", maxPoints, "-", "most key points of an image, spread evenly");
            v("gridCellPx",
              gridCellPx,
              "px",
              "side of the cells from which the strongest points are taken in turn");
            v("surfThreshold", surfThreshold, "-", "surf: least determinant of the Hessian");
            v("upright",
              upright,
              "-",
              "surf: no orientation; for cameras that roll less than 15 deg from frame to "
              "frame");
            v("fastThreshold", fastThreshold, "grey", "fast, orb: least contrast of a corner");
            v("akazeThreshold", akazeThreshold, "-", "akaze: least response");
            v("siftThreshold", siftThreshold, "-", "sift: least contrast");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    /** \throws std::invalid_argument naming the key */
    explicit PointDetector(const TParams& params);
    ~PointDetector();
    PointDetector(PointDetector&&) noexcept;
    PointDetector& operator=(PointDetector&&) noexcept;

    /** \param gray CV_8UC1
     * \return no points for an empty image
     * \throws std::invalid_argument on another image type */
    [[nodiscard]] DetectedPoints detect(const cv::Mat& gray) const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace pointplane
