// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/CameraImage.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace pointplane
{
struct PairingCounts
{
    std::uint64_t pairs{0};
    std::uint64_t droppedDepth{0};    //!< never arrived: gaps in the frame index or the stamps
    std::uint64_t droppedColour{0};   //!< likewise
    std::uint64_t unpairedDepth{0};   //!< arrived, but no colour image was near enough
    std::uint64_t unpairedColour{0};  //!< arrived, but no depth image was near enough
    double meanSkew{0};               //!< [s] colour minus depth, over the pairs
    double maxAbsSkew{0};             //!< [s]
};

/** Pairs the depth and colour images of one camera by their device time stamps.
 *
 * Each image is in at most one pair, and the two are at most maxSkew apart. With maxSkew up to half
 * a frame period, each gets the partner with the nearest stamp. An image whose partner cannot come
 * any more is counted and dropped. Within a stream images must come in order of time. It uses no
 * clock and no thread. */
class FramePairer
{
 public:
    /** \param maxSkew [s] largest distance of the two time stamps of a pair, > 0
     * \param period [s] of a stream, > 0 \param depthOnly every depth image is a pair without
     * colour */
    FramePairer(double maxSkew, double period, bool depthOnly = false);

    /** \return the pairs that this image completes, in order of time (their `stamp` is not set) */
    [[nodiscard]] std::vector<ImagePair> add(const CameraImage& image);

    /** Counts what still waits as unpaired: the end of the recording. */
    void finish();

    [[nodiscard]] const PairingCounts& counts() const { return counts_; }

 private:
    void countGap(const CameraImage& image);
    void dropOldest(StreamKind stream);
    ImagePair takePair();

    double maxSkew_, period_;
    bool depthOnly_;
    std::deque<CameraImage> depth_, colour_;
    std::optional<CameraImage> lastDepth_, lastColour_;  // without their pixels
    double sumSkew_{0};
    PairingCounts counts_;
};
}  // namespace pointplane
