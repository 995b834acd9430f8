// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/odometry/NoiseScale.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr double kMin = 0.1, kMax = 100;
}  // namespace

void NoiseScale::TParams::check() const
{
    POINTPLANE_CHECK(timeConstant > 0, "timeConstant = " << timeConstant << " is not positive");
    POINTPLANE_CHECK(initial > 0, "initial = " << initial << " is not positive");
}

NoiseScale::NoiseScale(const TParams& params) : params_(params)
{
    params_.check();
    if (params_.adaptive)
    {
        factors_ = {params_.initial, params_.initial};
    }
}

void NoiseScale::update(const PoseEstimate& estimate, double dt)
{
    if (!params_.adaptive)
    {
        return;
    }
    const double gain = 1 - std::exp(-dt / params_.timeConstant);
    const auto follow = [gain](double& factor, double chi2PerDof)
    {
        if (chi2PerDof > 0)
        {
            factor += gain * (std::clamp(chi2PerDof, kMin, kMax) - factor);
        }
    };
    follow(factors_.points, estimate.pointScale);
    follow(factors_.planes, estimate.planeScale);
}
}  // namespace pointplane
