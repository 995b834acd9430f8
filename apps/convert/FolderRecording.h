// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "FolderFrames.h"
#include "Recording.h"

namespace pointplane
{
class VideoFrames;

/** A folder of numbered or stamped images. Depth of another size than colour is taken as seen by a
 * camera of its own in the same place. */
class FolderRecording : public Recording
{
 public:
    /** \throws InputError */
    explicit FolderRecording(const FolderOptions& options);
    ~FolderRecording() override;

    [[nodiscard]] std::optional<RecordedFrame> next() override;
    [[nodiscard]] double progress() const override;
    [[nodiscard]] std::string groundTruth() const override { return groundTruth_; }
    [[nodiscard]] std::vector<std::string> notes() const override;

 private:
    void readPoses();
    void chooseCamera(const FolderOptions& options);
    [[nodiscard]] cv::Mat colourOf(const ImageRef& image);
    void readDepth(const ImageRef& image, RecordedFrame& frame);

    std::string folder_;
    FolderLayout layout_;
    FolderFrames frames_;
    double unitsPerMetre_{1000};
    double floatUnits_{1};  //!< the same, of depth in floating point
    bool isFloat_{false};   //!< depth has been
    std::string groundTruth_;
    std::size_t numPoses_{0};
    std::size_t next_{0};
    std::unique_ptr<VideoFrames> video_;
};
}  // namespace pointplane
