// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>
#include <pointplane/sensor/PinholeCamera.h>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <string>
#include <vector>

#include "Reference.h"

namespace pointplane
{
/** A point that seems to be fixed to the image. */
struct Mark
{
    Eigen::Vector2d uv_px{0, 0};
    int reference{0};  //!< which shows it
};

/** The fixedPoints of associations. */
[[nodiscard]] std::vector<Mark> marksIn(const std::vector<Association>& associations);

/** Finds what is fixed to the colour image, like text, spots that the camera projects, or dirt on
 * the lens. Its corners say that the camera stands (docs/theory.md, "Marks in the images").
 *
 * What a standing camera sees keeps its place in the image, and its depth, but for changes of the
 * sensor over the whole image. Marks keep their place while the depth behind them changes
 * otherwise. In one frame that may be depth that is wrong. In a second one, if no frame between
 * shows the depth as it was, it is marks. From then on, points that stand in the image do not
 * count. */
class ImageMarks
{
 public:
    /** \param windowPx side of the patch by which a point is found again [px] */
    explicit ImageMarks(int windowPx) : radius_px_(windowPx / 2) {}

    /** Takes points that stand in the image out of an association: to fixedPoints if the depth
     * behind many of them has changed, else to doubtedPoints once marks are known, as points that
     * are found where a mark is. If these are most of the points, no point counts. */
    void split(Association& association, const PinholeCamera& camera) const;

    [[nodiscard]] bool areKnown() const { return areKnown_; }

    /** Learns from a frame, once.
     * \param associations by which its motion was estimated
     * \param marks of all attempts to estimate it
     * \return whether marks are known from this frame on */
    bool learn(
        const std::vector<Association>& associations,
        const std::vector<Mark>& marks,
        const PinholeCamera& camera);

    /** Learns from the motion of a frame, which was measured without the points that stand: those
     * that it should have moved, surely, are marks. */
    void learn(
        const std::vector<Association>& associations,
        const PinholeCamera& camera,
        const PoseGaussian& T_cur_world);

    /** Why no point counts, or empty. */
    [[nodiscard]] std::string whyNoPoint(const std::vector<Association>& associations) const;

    /** For another camera. */
    void forget();

    /** Not 0 (CV_8UC1, of the depth image's size) near marks that were found; empty if there are
     * none. */
    [[nodiscard]] const cv::Mat& mask() const { return mask_; }

 private:
    [[nodiscard]] bool seesMark(const Eigen::Vector2d& depthUv_px) const;
    void add(const Eigen::Vector2d& uv_px, const PinholeCamera& camera);

    static constexpr int kNone = -1;

    int radius_px_;
    bool areKnown_{false};
    int suspectedOf_{kNone};  //!< the newest reference that shows marks
    cv::Mat mask_;
};
}  // namespace pointplane
