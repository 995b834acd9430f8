// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "Recording.h"
#include "TumFolder.h"
#include "calibration_file.h"
#include "tum_truth.h"

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
    /** Of readTumTruth(). */
    [[nodiscard]] std::string groundTruth() const override { return truth_.text; }

 private:
    struct Frame
    {
        std::optional<std::size_t> colour;  //!< nothing: depth alone
        std::size_t depth;
    };

    void readLists();
    void pairImages();
    /** Depth after colour [s]. */
    [[nodiscard]] double delayOf(const Frame& frame) const;
    [[nodiscard]] std::vector<std::string> notesOfPairs() const;

    TumOptions options_;
    std::vector<TumImage> colour_, depth_;
    Calibration camera_;
    std::vector<Frame> frames_;
    TumTruth truth_;
    std::string evening_;  //!< what was done to the stamps, or empty
    std::size_t next_{0};
};
}  // namespace pointplane
