// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/OutputFolder.h>

#include <optional>
#include <set>
#include <string>

#include "Sink.h"
#include "overlay.h"

namespace pointplane
{
/** Writes a picture of every N-th frame: <folder>/000042.jpg. */
class OverlaySink : public Sink
{
 public:
    /** \throws EnvironmentError if the folder cannot be created, or another program writes there */
    OverlaySink(const std::string& folder, std::size_t every);

    void add(const OutputItem& item) override;
    void close() override {}
    void discard() noexcept override { folder_.removeIfNew(); }  // each picture is complete
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] bool needsFeatures() const override { return true; }

 private:
    [[nodiscard]] cv::Size sizeOf(const OutputItem& item);
    [[nodiscard]] std::optional<CameraSpeed> speedAt(const OutputItem& item);
    [[nodiscard]] std::set<std::string> earlierPictures() const;

    OutputFolder folder_;
    std::size_t every_;
    std::size_t numFrames_{0};
    std::set<std::string> names_;          //!< of the files
    std::optional<cv::Size> size_;         //!< of the latest images
    std::optional<double> firstStamp_;     //!< [s]
    std::optional<double> measuredStamp_;  //!< of the latest frame that was measured [s]
    Eigen::Isometry3d measuredPose_{Eigen::Isometry3d::Identity()};
};
}  // namespace pointplane
