// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/pose/PoseSolver.h>

#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace pointplane
{
/** Tells noise from drift, by comparing the residuals of the same features from frame to frame:
 * what changes at once is noise, what changes with the view is drift. Residuals of single frames
 * cannot tell these two apart, and cameras and scenes differ in each by more than a factor of ten.
 *
 * The variogram (Matheron 1963) is half of the mean squared difference of two residuals, by the
 * distance between them. White noise of variance w beside a random walk makes it a line: w + g
 * times the views between the frames. Both w and g are over the propagated variance. It is drawn
 * through two points: the frame before, and the farthest within one view and the time constant. */
class ResidualVariogram
{
 public:
    struct Levels
    {
        NoiseFactors white;  //!< w
        NoiseFactors drift;  //!< g, per view (numViews())
    };

    /** \param timeConstant over which both levels are learnt [s] */
    explicit ResidualVariogram(double timeConstant) : timeConstant_(timeConstant) {}

    /** Learns from a measured frame.
     * \param R_world_prev orientation of the previous frame, in which its residuals are
     * \param views since the measured frame before, `dt` [s] earlier
     * \param residuals variance of all residuals, from which the levels are guessed at first */
    void update(
        const PoseAnalysis& analysis,
        const Eigen::Matrix3d& R_world_prev,
        double views,
        double dt,
        const NoiseFactors& residuals);

    [[nodiscard]] Levels levels() const
    {
        return {{points_.white, planes_.white}, {points_.drift, planes_.drift}};
    }

 private:
    struct Entry
    {
        std::pair<int, int> key;  //!< reference, feature in it
        Eigen::Vector3d r;        //!< in the world's axes
        Eigen::Matrix3d cov;      //!< of the current feature
        double share;             //!< variance of r over that, by white noise
    };
    using Snapshot = std::vector<Entry>;  //!< by key

    /** From one measured frame to the next. */
    struct Step
    {
        double views, dt;
    };

    /** Of points, or of planes. */
    struct Kind
    {
        std::deque<Snapshot> past;            //!< the latest first
        double weight{0}, step{0}, views{0};  //!< sums over frames: variogram of neighbours
        double growth{0}, farther{0};         //!< of its slope: way times growth, way squared
        double white{0.1}, drift{0.2};
    };

    [[nodiscard]] Snapshot snapshot(
        const std::vector<FeatureResidual>& residuals,
        const Eigen::Matrix3d& R_world_prev,
        double ownWhite) const;
    [[nodiscard]] static std::optional<double> variogram(const Snapshot& now, const Snapshot& then);
    [[nodiscard]] static bool shareReference(const Snapshot& now, const Snapshot& then);
    void update(Kind& kind, Snapshot now, double kept, double residuals) const;

    double timeConstant_;
    Kind points_, planes_;
    std::deque<Step> steps_;  //!< between neighbouring frames, the latest first
};
}  // namespace pointplane
