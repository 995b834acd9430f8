// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <functional>
#include <string>
#include <vector>

namespace pointplane
{
/** A frame that an odometry gets. */
struct FrameUse
{
    std::size_t at{0};     //!< frame of the sequence whose time and place it has
    std::size_t shown{0};  //!< frame whose images it has: another one when the camera is frozen
    std::function<RgbdFrame(const RgbdFrame&)> change;  //!< of the images; empty: none
};

/** What an odometry that starts anew gets, in order. */
using EnvelopeRun = std::vector<FrameUse>;

/** What becomes of a recording, in several places or from several starting frames. */
struct Condition
{
    std::string name;
    std::vector<EnvelopeRun> runs;
};

struct ConditionOptions
{
    std::vector<double> rates{30, 15, 10, 6, 3, 2, 1};  //!< [Hz]
    std::vector<int> gaps{3, 6, 10, 15, 25, 50};        //!< [frames]
    std::vector<int> frozen{3, 15};                     //!< [frames]
    std::vector<int> foreign{1};                        //!< [frames]
    int places{10};                                     //!< of each gap, at most
    int phases{30};                                     //!< of each rate: starting frames, at most
    int before{20};                                     //!< frames that lead up to a gap
    int after{15};                                      //!< frames after it
};

/** All that a recording can go through: other rates, gaps, images that are missing, black,
 * frozen or of another place, fewer pixels, less range, holes and noise. What it is too short or
 * too slow for is left out. \param numFrames of the recording \param rate its own [Hz] */
[[nodiscard]] std::vector<Condition> envelopeConditions(
    std::size_t numFrames, double rate, const ConditionOptions& options);
}  // namespace pointplane
