// SPDX-License-Identifier: BSD-3-Clause
#include "envelope_overview.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "MarkdownGrid.h"
#include "envelope_cells.h"

namespace pointplane
{
namespace
{
using Value = double EnvelopeScore::*;
using Format = std::function<std::string(double)>;

/** Our error, bold where a tracked step is beyond five standard deviations; in brackets the least
 * of a peer. */
std::string besideBestPeer(const Cell& cell, Value value, const Format& format)
{
    const EnvelopeScore& own = *cell.own;
    std::string out = own.numPairs > 0 ? format(own.*value) : "-";
    out = own.beyond.empty() ? out : "**" + out + "**";
    const EnvelopeScore* peer = bestPeer(cell, value);
    return peer == nullptr ? out : out + " (" + format(peer->*value) + ")";
}

std::string millimetres(double metres) { return lengthText(metres); }

std::string degreesText(double radians) { return text("%.2f", degrees(radians)); }

/** What is told of a sequence under its only condition. */
void addAlone(MarkdownGrid& grid, const Cell& cell)
{
    const EnvelopeScore& own = *cell.own;
    grid.add(own.sequence, "tracked %", shareText(own));
    grid.add(
        own.sequence,
        "RPE, mm (best peer)",
        besideBestPeer(cell, &EnvelopeScore::rpeTranslation, millimetres));
    grid.add(
        own.sequence,
        "deg (best peer)",
        besideBestPeer(cell, &EnvelopeScore::rpeRotation, degreesText));
    grid.add(own.sequence, "worst step", errorText(own.worstTranslation, own.worstRotation));
    grid.add(own.sequence, "beyond 5σ", std::to_string(own.beyond.size()));
    grid.add(
        own.sequence,
        "NEES median / 99 %",
        own.neesMedian ? text("%.2f / %.1f", *own.neesMedian, *own.nees99) : "-");
}

std::string section(const MarkdownGrid& grid, const std::string& title, const std::string& heading)
{
    return grid.isEmpty() ? "" : "\n" + title + "\n\n" + grid.markdown(heading);
}
}  // namespace

std::string envelopeOverview(const std::vector<EnvelopeScore>& scores)
{
    const std::vector<Cell> cells = cellsOf(scores);
    std::map<std::string, int> numConditions;
    for (const Cell& cell : cells)
    {
        ++numConditions[cell.own->sequence];
    }
    MarkdownGrid translation, rotation, steps, alone;
    for (const Cell& cell : cells)
    {
        const EnvelopeScore& own = *cell.own;
        if (own.truth == Truth::None)
        {
            const std::string step = lengthText(own.worstTranslation);
            steps.add(own.condition, own.sequence, shareText(own) + " %, " + step);
        }
        else if (numConditions[own.sequence] == 1)
        {
            addAlone(alone, cell);
        }
        else
        {
            translation.add(
                own.condition,
                own.sequence,
                besideBestPeer(cell, &EnvelopeScore::rpeTranslation, millimetres));
            rotation.add(
                own.condition,
                own.sequence,
                besideBestPeer(cell, &EnvelopeScore::rpeRotation, degreesText));
        }
    }
    return section(translation, "RPE over a second, mm (best peer):", "condition") +
           section(rotation, "The same, deg:", "condition") +
           section(
               steps,
               "Where there is no ground truth: tracked frames, and the largest tracked step in "
               "mm:",
               "condition") +
           section(alone, "At 30 Hz only:", "sequence");
}
}  // namespace pointplane
