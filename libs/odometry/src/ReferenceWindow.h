// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/ReferenceParams.h>

#include <deque>
#include <optional>
#include <vector>

#include "Reference.h"

namespace pointplane
{
/** Keeps the frames that the current one is compared with, and decides which become key frames. */
class ReferenceWindow
{
 public:
    /** \throws std::invalid_argument naming the key */
    explicit ReferenceWindow(const ReferenceParams& params);

    [[nodiscard]] bool empty() const { return !previous_; }
    /** \pre !empty() */
    [[nodiscard]] const Reference& previous() const { return *previous_; }

    /** The previous frame first, then the key frames, newest first. */
    [[nodiscard]] std::vector<const Reference*> active() const;

    /** Whether this is the newest frame with points, which overlap() is about. */
    [[nodiscard]] bool isNewest(const Reference& reference) const;

    /** What can be found in a frame at all: no points without a new colour image, no planes without
     * a new depth image. */
    struct Findable
    {
        bool points{true}, planes{true};
    };

    /** Fraction of the newest key frame's points, or of its planes, that was found again: the
     * smaller of the two, of what can be found, in [0, 1]; 0 without associations. */
    [[nodiscard]] double overlap(
        const std::vector<Association>& associations, const Findable& findable) const;

    /** \param overlap of the frame with the newest key frame, in [0, 1] */
    [[nodiscard]] bool needsKeyframe(const Eigen::Isometry3d& T_world_cam, double overlap) const;

    /** Corrects the velocity of the previous frame, now that the next one is known. */
    void refinePreviousVelocity(const Vector6d& velocity);

    /** All stamps become later by so much [s]. */
    void changeStamps(double by);

    /** Counts which points of a frame in the window were found again. */
    void notePoints(const Association& association);

    /** Makes a frame the previous one and, if wanted, the newest key frame. */
    void add(Reference frame, bool isKeyframe);

    /** Older key frames, oldest first. Frames are not compared with them until recall(). */
    [[nodiscard]] const std::deque<Reference>& places() const { return places_; }

    /** Makes a place the newest key frame. \throws std::invalid_argument if `id` is not a place */
    void recall(int id);

    /** Ends the window: the key frames become places, and the next frame starts a new one. */
    void leave();

    /** Forgets everything, also the places. */
    void clear();

 private:
    void addKeyframe(Reference frame);
    void addPlace(Reference frame);

    ReferenceParams params_;
    bool isFrameToFrame_;
    std::optional<Reference> previous_;
    std::deque<Reference> keyframes_;  //!< oldest first
    std::deque<Reference> places_;     //!< oldest first
};
}  // namespace pointplane
