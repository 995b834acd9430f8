// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/points/PointDetector.h>
#include <pointplane/points/PointLifter.h>
#include <pointplane/points/PointMatcher.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <opencv2/core/mat.hpp>

#include <optional>
#include <vector>

namespace pointplane
{
/** Key points of a frame that can be found again without knowing where they are. */
struct DescribedPoints
{
    std::vector<PointFeature> points;
    cv::Mat descriptors;  //!< a row a point
};

/** Motion that images alone tell. */
struct ImageMotion
{
    Eigen::Isometry3d T_cur_ref{Eigen::Isometry3d::Identity()};
    int numInliers{0};
    int numMatches{0};
};

/** Motion between two frames without a prediction: key points matched by descriptor over the whole
 * image, motions from three of them each (Fischler and Bolles 1981; Horn 1987), judged by all.
 * Deterministic. */
class ImageAligner
{
 public:
    ImageAligner(const PointLifter::TParams& lifter, const DepthNoise& noise);

    void setNoise(const DepthNoise& noise) { noise_ = noise; }

    [[nodiscard]] DescribedPoints describe(const RgbdFrame& frame) const;

    /** \return nothing where fewer than kLeastInliers agree */
    [[nodiscard]] std::optional<ImageMotion> align(
        const DescribedPoints& reference,
        const DescribedPoints& current,
        const PinholeCamera& camera) const;

 private:
    PointDetector detector_;
    PointMatcher matcher_;
    PointLifter lifter_;
    DepthNoise noise_;
};
}  // namespace pointplane
