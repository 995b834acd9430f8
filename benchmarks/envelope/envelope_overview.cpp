// SPDX-License-Identifier: BSD-3-Clause
#include "envelope_overview.h"

#include <pointplane/evaluation/Statistics.h>

#include <algorithm>
#include <map>
#include <utility>

#include "MarkdownGrid.h"
#include "envelope_cells.h"

namespace pointplane
{
namespace
{
/** Our error, bold where a tracked step is beyond five standard deviations; in brackets the least
 * of a peer. */
std::string besideBestPeer(const Cell& cell)
{
    const EnvelopeScore& own = *cell.own;
    std::string out =
        own.failure.empty() && own.numPairs > 0 ? lengthText(own.rpeTranslation) : rpeText(own);
    out = own.beyond.empty() ? out : "**" + out + "**";
    const EnvelopeScore* peer = bestPeer(cell, &EnvelopeScore::rpeTranslation);
    return peer == nullptr ? out : out + " (" + lengthText(peer->rpeTranslation) + ")";
}

bool hasPeer(const Cell& cell) { return bestPeer(cell, &EnvelopeScore::rpeTranslation) != nullptr; }

/** What is told of a sequence if there is one condition. */
void addAlone(MarkdownGrid& grid, const Cell& cell, bool withPeers)
{
    const EnvelopeScore& own = *cell.own;
    grid.add(own.sequence, withPeers ? "mm (best peer)" : "mm", besideBestPeer(cell));
    grid.add(own.sequence, "worst step", worstStepText(own));
    grid.add(
        own.sequence,
        "NEES median / 99 %",
        own.neesMedian ? text("%.2f / %.1f", *own.neesMedian, *own.nees99) : "-");
}

/** What is told of a sequence under several conditions. */
struct Summary
{
    std::size_t numCells{0}, numBeyond{0}, numFailures{0};
    std::vector<double> translation, rotation, peerTranslation, peerRotation;
    std::vector<double> shares;  //!< of tracked frames [%]
    double largestStep{0};       //!< [m]

    void add(const Cell& cell)
    {
        const EnvelopeScore& own = *cell.own;
        ++numCells;
        numBeyond += own.beyond.empty() ? 0 : 1;
        numFailures += own.failure.empty() ? 0 : 1;
        shares.push_back(std::stod(shareText(own)));
        largestStep = std::max(largestStep, own.worstTranslation);
        if (own.failure.empty() && own.numPairs > 0)
        {
            translation.push_back(own.rpeTranslation);
            rotation.push_back(own.rpeRotation);
        }
        const EnvelopeScore* t = bestPeer(cell, &EnvelopeScore::rpeTranslation);
        const EnvelopeScore* r = bestPeer(cell, &EnvelopeScore::rpeRotation);
        if (t != nullptr && r != nullptr)
        {
            peerTranslation.push_back(t->rpeTranslation);
            peerRotation.push_back(r->rpeRotation);
        }
    }
};

std::string cellsText(const Summary& s)
{
    return std::to_string(s.numCells) +
           (s.numFailures > 0 ? text(", gave up in %zu", s.numFailures) : "");
}

std::string medians(const std::vector<double>& translation, const std::vector<double>& rotation)
{
    return translation.empty()
               ? "-"
               : errorText(statisticsOf(translation).median, statisticsOf(rotation).median);
}

void addSummary(MarkdownGrid& grid, const std::string& sequence, const Summary& s)
{
    grid.add(sequence, "cells", cellsText(s));
    grid.add(sequence, "RPE", medians(s.translation, s.rotation));
    if (!s.peerTranslation.empty())
    {
        grid.add(sequence, "best peer's", medians(s.peerTranslation, s.peerRotation));
    }
    grid.add(sequence, "cells with steps beyond 5σ", std::to_string(s.numBeyond));
}

void addSteps(MarkdownGrid& grid, const std::string& sequence, const Summary& s)
{
    grid.add(sequence, "cells", cellsText(s));
    const Statistics shares = statisticsOf(s.shares);
    grid.add(sequence, "tracked %, median", text("%.4g", shares.median));
    grid.add(sequence, "least", text("%.0f", shares.min));
    grid.add(sequence, "largest tracked step, mm", lengthText(s.largestStep));
}

std::string section(const MarkdownGrid& grid, const std::string& title, const std::string& heading)
{
    return grid.isEmpty() ? "" : "\n" + title + "\n\n" + grid.markdown(heading);
}
}  // namespace

std::string envelopeOverview(const std::vector<EnvelopeScore>& scores)
{
    const std::vector<Cell> cells = cellsOf(scores);
    std::map<std::string, Summary> sums;
    for (const Cell& cell : cells)
    {
        sums[cell.own->sequence].add(cell);
    }
    const bool isAlone = hasOneCondition(scores);
    const bool withPeers = std::any_of(cells.begin(), cells.end(), hasPeer);
    MarkdownGrid sequences, steps, alone;
    for (const Cell& cell : cells)
    {
        const Summary& sum = sums[cell.own->sequence];
        if (cell.own->truth == Truth::None)
        {
            addSteps(steps, cell.own->sequence, sum);
        }
        else if (isAlone)
        {
            addAlone(alone, cell, withPeers);
        }
        else
        {
            addSummary(sequences, cell.own->sequence, sum);
        }
    }
    return section(sequences, "RPE over a second, mm / deg: the median cell.", "sequence") +
           section(steps, "Where there is no ground truth:", "sequence") +
           section(alone, "RPE over a second:", "sequence");
}
}  // namespace pointplane
