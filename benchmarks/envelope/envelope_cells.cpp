// SPDX-License-Identifier: BSD-3-Clause
#include "envelope_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace pointplane
{
std::string text(const char* format, ...)
{
    char out[256];
    va_list args;
    va_start(args, format);
    std::vsnprintf(out, sizeof out, format, args);
    va_end(args);
    return out;
}

std::string lengthText(double metres)
{
    return text("%.*f", mm(metres) < 9.95 ? 1 : 0, mm(metres));
}

std::string errorText(double metres, double radians)
{
    return lengthText(metres) + text(" / %.2f", degrees(radians));
}

std::string rpeText(const EnvelopeScore& s)
{
    return !s.failure.empty() ? "gave up"
           : s.numPairs > 0   ? errorText(s.rpeTranslation, s.rpeRotation)
                              : "-";
}

std::string worstStepText(const EnvelopeScore& s)
{
    return s.failure.empty() ? errorText(s.worstTranslation, s.worstRotation) : "gave up";
}

std::string shareText(const EnvelopeScore& s)
{
    const auto all = static_cast<double>(std::max<std::size_t>(s.numSteps, 1));
    return text("%.0f", std::floor(100 * static_cast<double>(s.numTracked) / all));
}

std::vector<Cell> cellsOf(const std::vector<EnvelopeScore>& scores)
{
    std::vector<Cell> out;
    for (const EnvelopeScore& s : scores)
    {
        if (out.empty() || out.back().own->sequence != s.sequence ||
            out.back().own->condition != s.condition)
        {
            out.push_back({&s, {}, {}});
            continue;
        }
        (s.isPeer ? out.back().peers : out.back().others).push_back(&s);
    }
    return out;
}

bool hasOneCondition(const std::vector<EnvelopeScore>& scores)
{
    return std::all_of(
        scores.begin(),
        scores.end(),
        [&](const EnvelopeScore& s) { return s.condition == scores.front().condition; });
}

const EnvelopeScore* bestPeer(const Cell& cell, double EnvelopeScore::*value)
{
    const EnvelopeScore* best = nullptr;
    for (const EnvelopeScore* s : cell.peers)
    {
        if (s->failure.empty() && s->numPairs > 0 && std::isfinite(s->*value) &&
            (best == nullptr || s->*value < best->*value))
        {
            best = s;
        }
    }
    return best;
}
}  // namespace pointplane
