// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/odometry/NoiseScale.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** A few odd frames must neither make features certain nor worthless. */
constexpr double kMinVariance = 0.1, kMaxVariance = 100;

/** Before anything is known. */
constexpr double kInitialVariance = 4;
}  // namespace

void NoiseScale::TParams::check() const
{
    POINTPLANE_CHECK(timeConstant > 0, "timeConstant = " << timeConstant << " is not positive");
    POINTPLANE_CHECK(
        agreementTimeConstant > 0,
        "agreementTimeConstant = " << agreementTimeConstant << " is not positive");
    POINTPLANE_CHECK(pointFactor > 0, "pointFactor = " << pointFactor << " is not positive");
    POINTPLANE_CHECK(planeFactor > 0, "planeFactor = " << planeFactor << " is not positive");
}

NoiseScale::NoiseScale(const TParams& params) : params_(params)
{
    params_.check();
    if (params_.adaptive)
    {
        residuals_ = {kInitialVariance, kInitialVariance};
    }
}

void NoiseScale::update(const PoseEstimate& estimate, double dt)
{
    if (!params_.adaptive)
    {
        return;
    }
    const auto follow = [dt](double& average, double variance, double timeConstant)
    {
        if (variance > 0)
        {
            const double rate = 1 - std::exp(-dt / timeConstant);
            average += rate * (std::clamp(variance, kMinVariance, kMaxVariance) - average);
        }
    };
    follow(residuals_.points, estimate.pointVariance, params_.timeConstant);
    follow(residuals_.planes, estimate.planeVariance, params_.timeConstant);

    // The solver was told common_ times the constant factor, which is not for this.
    const auto needed = [](const Disagreement& d, double told)
    { return d.expected > 0 ? told * d.observed / d.expected : 0; };
    follow(
        common_.points,
        needed(estimate.pointDisagreement, common_.points * params_.pointFactor),
        params_.agreementTimeConstant);
    follow(
        common_.planes,
        needed(estimate.planeDisagreement, common_.planes * params_.planeFactor),
        params_.agreementTimeConstant);
}

NoiseFactors NoiseScale::factors() const
{
    return {
        residuals_.points * common_.points * params_.pointFactor,
        residuals_.planes * common_.planes * params_.planeFactor};
}
}  // namespace pointplane
