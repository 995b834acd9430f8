// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/range.h>
#include <pointplane/odometry/uncertainty/NoiseScale.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
double NoiseScale::plausible(double variance) { return std::clamp(variance, 0.1, 100.0); }

void NoiseScale::TParams::check() const
{
    checkRange("timeConstant", timeConstant, 0.01, 1000);
    checkRange("pointFactor", pointFactor, 0.01, 1000);
    checkRange("planeFactor", planeFactor, 0.01, 1000);
}

NoiseScale::NoiseScale(const TParams& params) : params_(params)
{
    params_.check();
    if (params_.adaptive)
    {
        pointResiduals_.cautious = planeResiduals_.cautious = kFirstVariance;
        pointResiduals_.quick = planeResiduals_.quick = kFirstVariance;
        pointResiduals_.typical = planeResiduals_.typical = kFirstVariance;
    }
}

void NoiseScale::update(const PoseAnalysis& analysis, double dt)
{
    if (!params_.adaptive)
    {
        return;
    }
    pointResiduals_.follow(analysis.pointVariance, dt, params_.timeConstant);
    planeResiduals_.follow(analysis.planeVariance, dt, params_.timeConstant);
    scatter_.follow(analysis.scatter, dt, params_.timeConstant);

    // The solver was told common_ times the constant factor, which is not for this.
    const auto needed = [](const Disagreement& d, double told)
    { return d.expected > 0 ? told * d.observed / d.expected : 0; };
    pointCommon_.follow(
        needed(analysis.pointDisagreement, pointCommon_.cautious * params_.pointFactor),
        dt,
        params_.timeConstant);
    planeCommon_.follow(
        needed(analysis.planeDisagreement, planeCommon_.cautious * params_.planeFactor),
        dt,
        params_.timeConstant);
}

void NoiseScale::Average::follow(double variance, double dt, double timeConstant)
{
    if (variance > 0)
    {
        ++numFrames;
        const double target = plausible(variance);
        const double rate = 1 - std::exp(-dt / timeConstant);
        cautious += rate * (target - cautious);
        const double quickRate = std::max(rate, 1.0 / (numFrames + kFirstFrames));
        quick += quickRate * (target - quick);
        typical *= std::pow(target / typical, std::max(rate, 1.0 / (numFrames + 1)));
    }
}

void NoiseScale::Scatter::follow(double scatter, double dt, double timeConstant)
{
    ofFrame = 1;
    if (scatter > 0)
    {
        const double now = std::log(scatter);
        ofFrame = numFrames > 0 ? plausible(std::exp(now - usualLog)) : 1;
        ++numFrames;
        usualLog += std::max(1 - std::exp(-dt / timeConstant), 1.0 / numFrames) * (now - usualLog);
    }
}

double NoiseScale::overCautious() const
{
    const Average& average = pointResiduals_.numFrames > 0 ? pointResiduals_ : planeResiduals_;
    return average.quick / average.cautious;
}

NoiseFactors NoiseScale::factors() const
{
    return {
        pointResiduals_.cautious * pointCommon_.cautious * params_.pointFactor,
        planeResiduals_.cautious * planeCommon_.cautious * params_.planeFactor};
}
}  // namespace pointplane
