// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "EnvelopeScore.h"

namespace pointplane
{
/** All methods under one condition on one sequence; ours first. */
struct Cell
{
    const EnvelopeScore* own{nullptr};
    std::vector<const EnvelopeScore*> others;  //!< ours
    std::vector<const EnvelopeScore*> peers;
};

[[nodiscard]] std::vector<Cell> cellsOf(const std::vector<EnvelopeScore>& scores);

[[nodiscard]] bool hasOneCondition(const std::vector<EnvelopeScore>& scores);

/** The peer with the smallest RPE, or nullptr. */
[[nodiscard]] const EnvelopeScore* bestPeer(const Cell& cell, double EnvelopeScore::*value);

[[nodiscard]] inline double mm(double metres) { return 1e3 * metres; }
[[nodiscard]] inline double degrees(double radians) { return radians * 180 / M_PI; }

/** As printf. */
[[nodiscard]] __attribute__((format(printf, 1, 2))) std::string text(const char* format, ...);

/** Millimetres with as many digits as tell something. */
[[nodiscard]] std::string lengthText(double metres);

/** The same and degrees. */
[[nodiscard]] std::string errorText(double metres, double radians);

/** RPE over a second, or why there is none. */
[[nodiscard]] std::string rpeText(const EnvelopeScore& s);

/** Error of the worst tracked step, or why it is not known. */
[[nodiscard]] std::string worstStepText(const EnvelopeScore& s);

/** Tracked frames [%]. */
[[nodiscard]] std::string shareText(const EnvelopeScore& s);
}  // namespace pointplane
