// SPDX-License-Identifier: BSD-3-Clause
#include "align_somewhere.h"

#include "image_motions.h"

namespace pointplane
{
Alignment alignSomewhere(
    const Aligner& aligner,
    const FrontEnd& frontEnd,
    const Features& current,
    const ErrorModel& errors,
    Track& track,
    FrameDiagnostics& diagnostics)
{
    Alignment out = aligner.align(frontEnd, current, track, errors, diagnostics);
    if (out.holds || !out.unsettled.empty())
    {
        // What cannot be told in this frame, later frames may tell with the same references.
        return out;
    }
    // On a copy: what may be in view makes room only for what is.
    const auto holdsAfter = [&](const auto& change)
    {
        Track changed = track;
        FrameDiagnostics ignored = diagnostics;
        return change(changed) && aligner.align(frontEnd, current, changed, errors, ignored).holds;
    };
    const auto alignAfter = [&](const auto& change)
    {
        change(track);
        return aligner.align(frontEnd, current, track, errors, diagnostics);
    };
    const auto& places = track.places();
    for (auto place = places.rbegin(); place != places.rend() && aligner.searchesImages(); ++place)
    {
        const auto recall = [id = place->id](Track& t)
        {
            t.recall(id);
            return true;
        };
        if (recognises(frontEnd, current, *place) && holdsAfter(recall))
        {
            return alignAfter(recall);
        }
    }
    const auto restart = [](Track& t) { return t.restartAtUnmatched(); };
    return holdsAfter(restart) ? alignAfter(restart) : out;
}
}  // namespace pointplane
