// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/choice.h>
#include <pointplane/core/range.h>
#include <pointplane/odometry/ReferenceParams.h>

namespace pointplane
{
bool ReferenceParams::isFrameToFrame() const
{
    return chosen<bool>(
        "reference", reference, {{"keyframes", false}, {"previous", true}, {"adjacent", true}});
}

bool ReferenceParams::isAdjacent() const { return reference == "adjacent"; }

void ReferenceParams::check() const
{
    (void)isFrameToFrame();
    checkRange("maxKeyframes", maxKeyframes, 1, 50);
    checkRange("maxPlaces", maxPlaces, 0, 1000);
    checkLength("keyframeDistance", keyframeDistance, 0.001, 10);
    checkRange("keyframeAngleDeg", keyframeAngleDeg, 0.1, 180);
    checkRange("keyframeMinOverlap", keyframeMinOverlap, 0, 0.99);
}
}  // namespace pointplane
