// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/planes/PlaneFeature.h>
#include <pointplane/sensor/PinholeCamera.h>

#include <vector>

namespace pointplane
{
/** Indices of a plane in the reference frame and the same plane in the current one. */
struct PlaneMatch
{
    int ref{0};
    int cur{0};
};

/** Matches planes of two frames [P17, section Matching]. Their segments must overlap by at least
 * half of the smaller one, and their normals and distances must be alike. Of several candidates,
 * the one at the smallest plane-to-plane distance |d'N' - dN| wins [P17 Eq. 7], and each plane has
 * one match: the nearest pairs come first. The reference is first moved by the predicted motion;
 * with the identity this is the paper's test between adjacent frames. */
class PlaneMatcher
{
 public:
    struct TParams
    {
        double minOverlap{0.5};
        double maxNormalAngleDeg{10.0};
        double maxDistance{0.10};
        bool secondNearest{true};

        template <class V>
        void visit(V&& v)
        {
            v("minOverlap",
              minOverlap,
              "-",
              "least overlap: common pixels, as a fraction of the smaller segment");
            v("maxNormalAngleDeg", maxNormalAngleDeg, "deg", "largest angle between the normals");
            v("maxDistance",
              maxDistance,
              "m",
              "largest difference of the planes' distances d from the camera");
            v("secondNearest",
              secondNearest,
              "-",
              "a plane whose nearest candidate matches another gets the next one; false: none (as "
              "in the paper)");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    /** \throws std::invalid_argument naming the key */
    explicit PlaneMatcher(const TParams& params);

    /** \param T_cur_ref predicted motion
     * \return at most one match per reference plane and per current plane, sorted by reference
     * index */
    [[nodiscard]] std::vector<PlaneMatch> match(
        const PlaneSet& ref,
        const PlaneSet& cur,
        const PinholeCamera& camera,
        const Eigen::Isometry3d& T_cur_ref) const;

 private:
    TParams params_;
};
}  // namespace pointplane
