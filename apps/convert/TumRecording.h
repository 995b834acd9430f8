// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "Recording.h"
#include "TumFolder.h"
#include "calibration_file.h"

namespace pointplane
{
struct TumOptions
{
    std::string folder;
    std::string camera;          //!< preset or file; empty: camera.txt or the folder's name
    double depthScale{0};        //!< units per metre; 0: the camera's
    double maxDifference{0.02};  //!< between the stamps of colour and depth [s]
    bool evenStamps{false};      //!< evenStamps()
};

/** A folder of the TUM RGB-D benchmark: pairs of images, stamped with the colour image's time,
 * readings and pixels unchanged. Without rgb.txt: depth images alone, with their own stamps. */
class TumRecording : public Recording
{
 public:
    /** \throws InputError */
    explicit TumRecording(const TumOptions& options);

    [[nodiscard]] std::optional<RecordedFrame> next() override;
    [[nodiscard]] double progress() const override;
    [[nodiscard]] std::vector<std::string> notes() const override;

    /** Lists, camera, images: all that is read. */
    [[nodiscard]] std::vector<std::string> files() const;
    /** groundtruth.txt, or empty if there is none with poses. */
    [[nodiscard]] std::string groundTruth() const override { return groundTruth_; }

 private:
    struct Frame
    {
        std::optional<std::size_t> colour;  //!< nothing: depth alone
        std::size_t depth;
    };

    void readLists();
    void pairImages();
    void readGroundTruth();
    /** Depth after colour [s]. */
    [[nodiscard]] double delayOf(const Frame& frame) const;
    [[nodiscard]] std::vector<std::string> notesOfPairs() const;

    TumOptions options_;
    std::vector<TumImage> colour_, depth_;
    Calibration camera_;
    std::vector<Frame> frames_;
    std::string groundTruth_;
    std::string noTruth_;  //!< why there is a groundtruth.txt, but no ground truth, or empty
    std::string evening_;  //!< what was done to the stamps, or empty
    std::size_t next_{0};
};
}  // namespace pointplane
