// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

#include <opencv2/core/mat.hpp>

#include <vector>

namespace pointplane
{
/** Indices of a point in the reference frame and the same point in the current one. */
struct PointMatch
{
    int ref{0};
    int cur{0};
    float distance{0};  //!< of the descriptors: bits (binary) or L2 norm (float)
};

/** Matches points by descriptor [P17, section Matching]: a reference point belongs to the current
 * point with the nearest descriptor inside a circle around its expected position. Candidates are
 * all points in the circle or, with `neighbours` = k, those of the k nearest descriptors of the
 * whole image that lie in it. */
class PointMatcher
{
 public:
    struct TParams
    {
        double searchRadiusPx{50};  //!< around the expected position
        int neighbours{0};          //!< k of the descriptor search; 0 = all in the circle
        double maxRatio{0.9};       //!< nearest over second nearest distance; 1 = no test
        bool crossCheck{true};      //!< the reference must be the nearest of the current one too

        template <class V>
        void visit(V&& v)
        {
            v("searchRadiusPx",
              searchRadiusPx,
              "px",
              "with method = match: radius of the circle around the expected position");
            v("neighbours",
              neighbours,
              "-",
              "0: every key point in the circle is a candidate; k > 0: only those that are among "
              "the k nearest descriptors of the whole image (the paper's k-NN)");
            v("maxRatio",
              maxRatio,
              "-",
              "largest distance to the nearest descriptor, as a fraction of that to the "
              "second nearest; 1 = any");
            v("crossCheck",
              crossCheck,
              "-",
              "keep only pairs in which each is nearest to the other");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    PointMatcher() : PointMatcher(TParams{}) {}
    /** \throws std::invalid_argument naming the key */
    explicit PointMatcher(const TParams& params);

    /** \param predicted_px where each reference point is expected in the current image; a point
     * whose position is not finite is left out
     * \param refDescriptors, curDescriptors one row per point: CV_8UC1 (Hamming) or CV_32FC1 (L2)
     * \param cur_px the current points
     * \return at most one match per reference and per current point, sorted by reference index
     * \throws std::invalid_argument when counts, sizes or types disagree */
    [[nodiscard]] std::vector<PointMatch> match(
        const std::vector<Eigen::Vector2d>& predicted_px,
        const cv::Mat& refDescriptors,
        const std::vector<Eigen::Vector2d>& cur_px,
        const cv::Mat& curDescriptors) const;

    [[nodiscard]] double searchRadius_px() const { return params_.searchRadiusPx; }

 private:
    TParams params_;
};
}  // namespace pointplane
