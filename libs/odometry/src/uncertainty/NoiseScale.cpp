// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/range.h>
#include <pointplane/odometry/uncertainty/NoiseScale.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pointplane
{
namespace
{
/** In the quick mean, the first variance counts as so many frames. */
constexpr double kFirstFrames = 3;

/** Of residuals, before any is known: standard deviations are twice the stated ones. */
constexpr double kFirstVariance = 4;
}  // namespace

double NoiseScale::plausible(double variance)
{
    return std::clamp(variance, kLeastVariance, kMostVariance);
}

void NoiseScale::TParams::check() const
{
    checkRange("timeConstant", timeConstant, 0.01, 1000);
    checkRange("pointFactor", pointFactor, 0.01, 1000);
    checkRange("planeFactor", planeFactor, 0.01, 1000);
}

NoiseScale::Residuals::Residuals(double first)
    : cautious(first, std::numeric_limits<double>::infinity()), quick(first, kFirstFrames)
{
}

void NoiseScale::Residuals::follow(double variance, double rate)
{
    if (variance > 0)
    {
        cautious.follow(plausible(variance), rate);
        quick.follow(plausible(variance), rate);
    }
}

NoiseScale::NoiseScale(const TParams& params)
    : params_(params),
      pointResiduals_(params.adaptive ? kFirstVariance : 1),
      planeResiduals_(pointResiduals_),
      pointCommon_(1, std::numeric_limits<double>::infinity()),
      planeCommon_(pointCommon_),
      typicalResiduals_(std::log(pointResiduals_.quick.value()), 1),
      typicalDisagreement_(0, 1)
{
    params_.check();
}

void NoiseScale::update(const PoseAnalysis& analysis, double dt, bool tells)
{
    const double rate = 1 - std::exp(-dt / params_.timeConstant);
    if (analysis.turnVariance > 0)
    {
        typicalTurn_.follow(std::log(analysis.turnVariance), rate);
    }
    ofFrame_ = 1;
    if (params_.adaptive && tells)
    {
        learn(analysis, rate);
    }
}

void NoiseScale::learn(const PoseAnalysis& analysis, double rate)
{
    pointResiduals_.follow(analysis.pointVariance, rate);
    planeResiduals_.follow(analysis.planeVariance, rate);
    const auto followLog = [rate](double variance, FrameMean<>& mean)
    {
        if (variance > 0)
        {
            mean.follow(std::log(plausible(variance)), rate);
        }
    };
    followLog(analysis.pointVariance, typicalResiduals_);

    // What is expected is in proportion to what the solver was told beyond the residuals' variance.
    const auto needed = [](const Disagreement& d, double told)
    { return d.expected > 0 ? told * d.observed / d.expected : 0; };
    const double ofPoints =
        needed(analysis.pointDisagreement, pointCommon_.value() * params_.pointFactor);
    const double ofPlanes =
        needed(analysis.planeDisagreement, planeCommon_.value() * params_.planeFactor);
    followLog(ofPoints, typicalDisagreement_);
    for (const auto& [variance, mean] :
         {std::pair(ofPoints, &pointCommon_), std::pair(ofPlanes, &planeCommon_)})
    {
        if (variance > 0)
        {
            mean->follow(plausible(variance), rate);
        }
    }

    if (analysis.scatter > 0)
    {
        const double now = std::log(analysis.scatter);
        const bool isFirst = typicalScatter_.numFrames() == 0;
        ofFrame_ = isFirst ? 1 : plausible(std::exp(now - typicalScatter_.value()));
        typicalScatter_.follow(now, rate);
    }
}

NoiseScale::TypicalPoints NoiseScale::typicalPoints() const
{
    return {
        std::exp(typicalResiduals_.value()),
        std::exp(typicalDisagreement_.value()),
        typicalTurn_.numFrames() > 0 ? std::exp(typicalTurn_.value()) : 0};
}

double NoiseScale::overCautious() const
{
    const bool hasPoints = pointResiduals_.quick.numFrames() > kFirstFrames;
    const Residuals& of = hasPoints ? pointResiduals_ : planeResiduals_;
    return of.quick.value() / of.cautious.value();
}

NoiseFactors NoiseScale::factors() const
{
    return {
        pointResiduals_.cautious.value() * pointCommon_.value() * params_.pointFactor,
        planeResiduals_.cautious.value() * planeCommon_.value() * params_.planeFactor};
}
}  // namespace pointplane
