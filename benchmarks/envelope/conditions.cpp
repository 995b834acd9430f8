// SPDX-License-Identifier: BSD-3-Clause
#include "conditions.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "frame_changes.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kLeastFrames = 3;  //!< of a run

/** At most `count` whole numbers from low to high, both included, as evenly as possible. */
[[nodiscard]] std::vector<std::size_t> spread(std::size_t low, std::size_t high, int count)
{
    const auto n = std::min(high - low + 1, static_cast<std::size_t>(count));
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < n; ++k)
    {
        out.push_back(n == 1 ? (low + high) / 2 : low + k * (high - low) / (n - 1));
    }
    return out;
}

[[nodiscard]] std::string nameOf(double rate)
{
    char text[32];
    std::snprintf(text, sizeof text, "%g Hz", rate);
    return text;
}

/** Every n-th frame, from as many starting frames as there are. */
[[nodiscard]] Condition atRate(
    const std::string& name, std::size_t numFrames, std::size_t n, int phases)
{
    Condition out{name, {}};
    for (const std::size_t first : spread(0, n - 1, phases))
    {
        EnvelopeRun run;
        for (std::size_t k = first; k < numFrames; k += n)
        {
            run.push_back({k, k, {}});
        }
        if (run.size() >= kLeastFrames)
        {
            out.runs.push_back(std::move(run));
        }
    }
    return out;
}

void addRates(
    std::size_t numFrames,
    double rate,
    const ConditionOptions& options,
    std::vector<Condition>& out)
{
    constexpr double kTolerance = 0.2;
    for (const double wanted : options.rates)
    {
        const double n = std::round(rate / wanted);
        if (n >= 1 && std::abs(rate / n - wanted) <= kTolerance * wanted)
        {
            out.push_back(
                atRate(nameOf(wanted), numFrames, static_cast<std::size_t>(n), options.phases));
        }
    }
}

/** Appends the frame k of the sequence, which is in the gap since `begin`, or nothing. */
using GapFiller = std::function<void(std::size_t begin, std::size_t k, EnvelopeRun& run)>;

/** Something that lasts `length` frames, in several places. */
[[nodiscard]] Condition withGap(
    const std::string& name,
    std::size_t numFrames,
    int length,
    const ConditionOptions& options,
    const GapFiller& fill)
{
    Condition out{name + " " + std::to_string(length), {}};
    const auto gap = static_cast<std::size_t>(length);
    const auto before = static_cast<std::size_t>(options.before);
    const auto after = static_cast<std::size_t>(options.after);
    const std::size_t first = before / 2, last = gap + after / 3;  // the least on either side
    if (numFrames < first + last)
    {
        return out;
    }
    for (const std::size_t begin : spread(first, numFrames - last, options.places))
    {
        EnvelopeRun run;
        const std::size_t end = std::min(numFrames, begin + gap + after);
        for (std::size_t k = begin - std::min(begin, before); k < end; ++k)
        {
            if (k < begin || k >= begin + gap)
            {
                run.push_back({k, k, {}});
            }
            else
            {
                fill(begin, k, run);
            }
        }
        out.runs.push_back(std::move(run));
    }
    return out;
}

void addGaps(std::size_t numFrames, const ConditionOptions& options, std::vector<Condition>& out)
{
    const auto changed = [](RgbdFrame (*change)(const RgbdFrame&)) -> GapFiller
    {
        return [change](std::size_t, std::size_t k, EnvelopeRun& run) {
            run.push_back({k, k, change});
        };
    };
    const std::vector<std::pair<std::string, GapFiller>> kinds{
        {"gap", [](std::size_t, std::size_t, EnvelopeRun&) {}},
        {"no depth", changed(withoutDepth)},
        {"no colour", changed(withoutColour)},
        {"no images", changed(withoutImages)}};
    for (const auto& [name, fill] : kinds)
    {
        for (const int length : options.gaps)
        {
            out.push_back(withGap(name, numFrames, length, options, fill));
        }
    }
    for (const int length : options.foreign)
    {
        out.push_back(withGap("foreign", numFrames, length, options, changed(mirrored)));
    }
    const GapFiller frozen = [](std::size_t begin, std::size_t k, EnvelopeRun& run) {
        run.push_back({k, begin - 1, {}});
    };
    for (const int length : options.frozen)
    {
        out.push_back(withGap("frozen", numFrames, length, options, frozen));
    }
}

void addOtherCameras(std::size_t numFrames, std::vector<Condition>& out)
{
    using Change = std::function<RgbdFrame(const RgbdFrame&)>;
    const std::vector<std::pair<std::string, Change>> changes{
        {"half the pixels a side", [](const RgbdFrame& f) { return shrunk(f, 2); }},
        {"a quarter", [](const RgbdFrame& f) { return shrunk(f, 4); }},
        {"depth up to 2 m", [](const RgbdFrame& f) { return withDepthUpTo(f, 2.0F); }},
        {"depth up to 1 m", [](const RgbdFrame& f) { return withDepthUpTo(f, 1.0F); }},
        {"depth with holes", [](const RgbdFrame& f) { return withHoles(f, 0.6); }},
        {"noisy depth", [](const RgbdFrame& f) { return withNoisyDepth(f, 0.004); }},
        {"dim light", [](const RgbdFrame& f) { return dimmed(f, 0.25, 3); }},
        {"text in the images", withText},
        {"spots in the images", withSpots}};
    for (const auto& change : changes)
    {
        Condition condition = atRate(change.first, numFrames, 1, 1);
        for (EnvelopeRun& run : condition.runs)
        {
            for (FrameUse& use : run)
            {
                use.change = change.second;
            }
        }
        out.push_back(std::move(condition));
    }
}
}  // namespace

std::vector<Condition> envelopeConditions(
    std::size_t numFrames, double rate, const ConditionOptions& options)
{
    std::vector<Condition> out;
    addRates(numFrames, rate, options, out);
    addGaps(numFrames, options, out);
    addOtherCameras(numFrames, out);
    const auto isEmpty = [](const Condition& condition) { return condition.runs.empty(); };
    out.erase(std::remove_if(out.begin(), out.end(), isEmpty), out.end());
    return out;
}
}  // namespace pointplane
