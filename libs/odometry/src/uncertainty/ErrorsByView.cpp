// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorsByView.h"

#include <pointplane/odometry/uncertainty/NoiseScale.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
void ErrorsByView::update(
    const std::vector<ReferenceVariance>& residuals,
    const std::map<int, double>& correlation,
    double dt,
    double followed)
{
    const double kept = std::exp(-dt / timeConstant_);
    for (double* sum : {&sum_, &x_, &xx_, &y_, &xy_})
    {
        *sum *= kept;
    }
    for (const ReferenceVariance& of : residuals)
    {
        const double x = 1 - correlation.at(of.reference);
        const double known = own_ + byView_ * x;
        // A wrong match must not count like many right ones.
        const double y = std::clamp(
            of.variance, known / NoiseScale::kMostChange, known * NoiseScale::kMostChange);
        sum_ += of.dof;
        x_ += of.dof * x;
        xx_ += of.dof * x * x;
        y_ += of.dof * y;
        xy_ += of.dof * x * y;
    }
    fit();
    raised_ = std::max(1.0, followed / own_);
}

/** Before the first frame both are 1, which counts as the residuals of one plane. Neither is
 * negative. */
void ErrorsByView::fit()
{
    const double prior = PlanePair::dof();
    const double n = sum_ + prior, xx = xx_ + prior, y = y_ + prior, xy = xy_ + prior;
    const double determinant = n * xx - x_ * x_;
    own_ = (y * xx - xy * x_) / determinant;
    byView_ = (n * xy - x_ * y) / determinant;
    if (const double least = NoiseScale::plausible(own_); own_ < least)
    {
        own_ = least;
        byView_ = (xy - own_ * x_) / xx;
    }
    if (byView_ < 0)
    {
        byView_ = 0;
        own_ = NoiseScale::plausible(y / n);
    }
}
}  // namespace pointplane
