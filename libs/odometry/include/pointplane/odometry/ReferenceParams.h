// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>

#include <string>

namespace pointplane
{
/** Which frames a new one is compared with. */
struct ReferenceParams
{
    std::string reference{"keyframes"};
    int maxKeyframes{4};
    double keyframeDistance{0.15};
    double keyframeAngleDeg{10.0};
    double keyframeMinOverlap{0.35};
    int maxPlaces{20};

    template <class V>
    void visit(V&& v)
    {
        v("reference",
          reference,
          "-",
          "what a frame is compared with: keyframes (the latest tracked frame and a few "
          "earlier ones, which drifts least), previous (the latest tracked frame) or "
          "adjacent (the frame before, tracked or not, as in the paper)");
        v("maxKeyframes", maxKeyframes, "-", "number of key frames; the oldest is dropped");
        v("keyframeDistance",
          keyframeDistance,
          "m",
          "a frame becomes a key frame after this translation");
        v("keyframeAngleDeg", keyframeAngleDeg, "deg", "or after this rotation");
        v("keyframeMinOverlap",
          keyframeMinOverlap,
          "-",
          "or when less than this fraction of the newest key frame's points or planes is "
          "found again, even by a wide search");
        v("maxPlaces",
          maxPlaces,
          "-",
          "number of older key frames that are kept, so that a lost camera can find its "
          "place again; about 2 MB each at 640 x 480");
    }
    /** \throws std::invalid_argument naming the key */
    void check() const;
    [[nodiscard]] bool isFrameToFrame() const;  //!< or against key frames
    [[nodiscard]] bool isAdjacent() const;      //!< to the frame before, whatever became of it
};
}  // namespace pointplane
