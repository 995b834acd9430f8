// SPDX-License-Identifier: BSD-3-Clause
#include "ChartAxis.h"

#include <pointplane/core/number_text.h>

#include <algorithm>
#include <cmath>

#include "short_number.h"

namespace pointplane
{
namespace
{
/** 1, 2 or 5 times a power of ten, not smaller than `step`. */
double roundStep(double step)
{
    const double power = std::pow(10, std::floor(std::log10(step)));
    for (const double factor : {1.0, 2.0, 5.0})
    {
        if (factor * power >= step * (1 - 1e-9))
        {
            return factor * power;
        }
    }
    return 10 * power;
}

std::vector<ChartTick> evenTicks(double min, double max, double step)
{
    std::vector<ChartTick> out;
    const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
    for (double k = std::ceil(min / step - 1e-9); k * step <= max + 1e-9 * step; ++k)
    {
        out.push_back({k == 0 ? 0 : k * step, numberText(k == 0 ? 0 : k * step, decimals)});
    }
    return out;
}

/** One label tells no scale. */
bool tellScale(const std::vector<ChartTick>& ticks)
{
    const auto isLabelled = [](const ChartTick& tick) { return !tick.label.empty(); };
    return std::count_if(ticks.begin(), ticks.end(), isLabelled) >= 2;
}
}  // namespace

void ChartRange::add(double value)
{
    if (std::isfinite(value))
    {
        min = empty ? value : std::min(min, value);
        max = empty ? value : std::max(max, value);
        empty = false;
    }
}

ChartAxis::ChartAxis(ChartRange range, bool logarithmic, double pixelsAtMin, double pixelsAtMax)
    : min_(range.min),
      max_(range.max),
      logarithmic_(logarithmic && range.min > 0),
      pixelsAtMin_(pixelsAtMin),
      pixelsAtMax_(pixelsAtMax)
{
    if (!(max_ - min_ > 1e-12 * std::max(std::abs(min_), std::abs(max_))))
    {
        const double half = min_ == 0 ? 1 : 0.5 * std::abs(min_);
        min_ -= half;
        max_ += half;
    }
}

double ChartAxis::position(double value) const
{
    return logarithmic_ ? std::log(value / min_) / std::log(max_ / min_)
                        : (value - min_) / (max_ - min_);
}

double ChartAxis::pixelsOf(double value) const
{
    return pixelsAtMin_ + position(value) * (pixelsAtMax_ - pixelsAtMin_);
}

std::vector<ChartTick> ChartAxis::ticks(double spacing) const
{
    const double pixels = std::abs(pixelsAtMax_ - pixelsAtMin_);
    std::vector<ChartTick> out;
    if (logarithmic_)
    {
        out = decadeTicks(spacing / pixels);
    }
    for (double step = roundStep((max_ - min_) * spacing / pixels); !tellScale(out);
         step = roundStep(0.4 * step))
    {
        out = evenTicks(min_, max_, step);
    }
    return out;
}

std::vector<ChartTick> ChartAxis::decadeTicks(double spacing) const
{
    std::vector<ChartTick> out;
    const bool many = std::log10(max_ / min_) * spacing * 3 > 1;  // decades alone get labels
    for (double power = std::pow(10, std::floor(std::log10(min_))); power <= max_; power *= 10)
    {
        for (int k = 1; k < 10; ++k)
        {
            const double value = k * power;
            if (value >= min_ * (1 - 1e-9) && value <= max_ * (1 + 1e-9))
            {
                const bool labelled = k == 1 || (!many && (k == 2 || k == 5));
                out.push_back({value, labelled ? shortNumber(value) : ""});
            }
        }
    }
    return out;
}
}  // namespace pointplane
