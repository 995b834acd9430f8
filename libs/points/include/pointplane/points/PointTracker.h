// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/points/PointLifter.h>
#include <pointplane/points/PointReference.h>
#include <pointplane/sensor/DepthNoise.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <opencv2/core/mat.hpp>

#include <optional>
#include <vector>

namespace pointplane
{
/** Finds corners of a reference image again in later images, to a fraction of a pixel.
 *
 * Pyramidal Lucas-Kanade (Bouguet 2001) searches from the predicted position. Each image is
 * compared with the reference itself, so that positions do not drift. A track is accepted if the
 * search ended inside a circle around the prediction, at a place that looks like the reference
 * (correlation). */
class PointTracker
{
 public:
    struct TParams
    {
        int maxPoints{300};
        int minPoints{50};
        double minSpacingFraction{0.016};
        double cornerQuality{0.001};
        double maxNoisePx{0.2};
        int windowPx{15};
        int numLevels{4};
        double searchRadiusFraction{0.02};
        double minZncc{0.8};
        double sigmaPx{0.05};
        double depthVarianceFactor{3.0};

        template <class V>
        void visit(V&& v)
        {
            v("maxPoints", maxPoints, "-", "most corners of a reference frame");
            v("minPoints",
              minPoints,
              "-",
              "if there are fewer corners, points on edges are added, which tell one "
              "direction");
            v("minSpacingFraction",
              minSpacingFraction,
              "-",
              "least distance between corners, as a fraction of the image's width");
            v("cornerQuality",
              cornerQuality,
              "-",
              "weakest corner, as a fraction of the strongest");
            v("maxNoisePx",
              maxNoisePx,
              "px",
              "a point counts only in directions in which the image's noise moves it by less "
              "than this");
            v("windowPx", windowPx, "px", "side of the patch that is searched for");
            v("numLevels", numLevels, "-", "levels of the image pyramid");
            v("searchRadiusFraction",
              searchRadiusFraction,
              "-",
              "search radius around the predicted position, as a fraction of the image's "
              "width");
            v("minZncc",
              minZncc,
              "-",
              "least similarity of a match (zero-mean normalised cross-correlation)");
            v("sigmaPx",
              sigmaPx,
              "px",
              "noise of a tracked position, besides what does not fit in patches");
            v("depthVarianceFactor",
              depthVarianceFactor,
              "-",
              "factor on the variance of a corner's inverse depth, because depth is worse at "
              "texture");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    /** \throws std::invalid_argument naming the key */
    PointTracker(
        const TParams& params, const PointLifter::TParams& lifter, const DepthNoise& noise);

    /** Sets the noise of points that are lifted from now on. */
    void setNoise(const DepthNoise& noise);

    /** The image pyramid that track() needs. \param gray CV_8UC1 */
    [[nodiscard]] std::vector<cv::Mat> pyramid(const cv::Mat& gray) const;

    /** Takes the corners of a frame (Shi & Tomasi 1994, in the image at half its size) that have
     * depth; where there are few, points on edges, too. */
    [[nodiscard]] PointReference makeReference(const RgbdFrame& frame) const;

    /** Finds the points of a reference in a frame.
     * \param pyramid of the frame's image
     * \param T_cur_ref predicted motion
     * \param radiusFactor of the search radius. 1: points that are due are searched for. Above 1,
     * for a bad prediction: only some points, spread over the list, and less exactly
     * \return the tracks, in the reference's order; points in the camera frame [m] */
    [[nodiscard]] std::vector<PointTrack> track(
        const PointReference& reference,
        const RgbdFrame& frame,
        const std::vector<cv::Mat>& pyramid,
        const Eigen::Isometry3d& T_cur_ref,
        double radiusFactor = 1) const;

    /** How far from its predicted place a point is searched for, with a radiusFactor of 1 [px]. */
    [[nodiscard]] double searchRadius_px(const cv::Mat& gray) const
    {
        return params_.searchRadiusFraction * gray.cols;
    }

 private:
    /** How thoroughly points are searched for. */
    struct Search;
    [[nodiscard]] Search searchFor(double radius_px, bool isWide, size_t numPoints) const;
    /** A point of the reference that is looked for. */
    struct Sought;
    /** One that is found, before the noise of its position is known. */
    struct Found;
    [[nodiscard]] static std::vector<Sought> inView(
        const PointReference& reference,
        const RgbdFrame& frame,
        const Eigen::Isometry3d& T_cur_ref,
        const Search& search);
    [[nodiscard]] bool isFound(
        const Sought& point,
        const PointReference& reference,
        const cv::Mat& gray,
        const Search& search) const;
    [[nodiscard]] std::optional<Found> trackOf(
        const Sought& point,
        const PointReference& reference,
        const RgbdFrame& frame,
        const Eigen::Isometry3d& T_cur_ref,
        const Search& search) const;

    [[nodiscard]] static std::vector<PointTrack> withNoise(const std::vector<Found>& found);

    [[nodiscard]] DepthNoise cornerNoise(const DepthNoise& noise) const;

    TParams params_;
    PointLifter lifter_;
};
}  // namespace pointplane
