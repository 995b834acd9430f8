// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseAnalysis.h>

#include <map>
#include <vector>

namespace pointplane
{
/** Learns how large errors of a depth image are, as ratios of their variance to the expected one:
 * errors of its planes (w_C and w_zeta in docs/theory.md, section Window), or of the scale of depth
 * in its patches.
 *
 * Depth images are bent, and the outline of a plane depends on the view. While the camera stands, a
 * part of this error stays the same. It shows in the residuals against a reference that saw the
 * scene from elsewhere. So residuals grow with how unlike two views are:
 *
 *     E(variance) = own + byView (1 - correlation of the views)
 *
 * A line through what all references show tells both. It is fitted by least squares with a fading
 * memory. */
class ErrorsByView
{
 public:
    /** \param timeConstant of the memory [s] */
    explicit ErrorsByView(double timeConstant) : timeConstant_(timeConstant) {}

    /** Learns from a measured frame, `dt` [s] after the one before.
     * \param residuals variance of the residuals over the expected one, by reference
     * \param correlation of the views of frame and reference, by the reference's id
     * \param followed PlaneResiduals::followed; own() is at least this. A pose that nothing but
     * planes tells follows them, and their residuals are small whatever their errors are */
    void update(
        const std::vector<ReferenceVariance>& residuals,
        const std::map<int, double>& correlation,
        double dt,
        double followed = 0);

    /** Variance that is new in each frame. */
    [[nodiscard]] double own() const { return raised_ * own_; }

    /** Variance that frames share as far as their views are alike. */
    [[nodiscard]] double byView() const { return raised_ * byView_; }

 private:
    void fit();

    double timeConstant_;
    double own_{1}, byView_{1};
    double raised_{1};  //!< factor on both, for what residuals cannot show
    /** Sums over what was seen: weight, and with it x = 1 - correlation, the variance y. */
    double sum_{0}, x_{0}, xx_{0}, y_{0}, xy_{0};
};
}  // namespace pointplane
