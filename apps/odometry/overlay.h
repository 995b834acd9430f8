// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <string>

#include "FrameRecord.h"

namespace pointplane
{
/** A picture of what was found in a frame, as [P17, Fig. 4]: points as circles, planes coloured by
 * the standard deviation of their distance (blue small, red large), status and counts in a line.
 * \param gray CV_8UC1, may be empty \param depth CV_32FC1 [m], shown where there is no gray image
 * \return CV_8UC3, BGR */
[[nodiscard]] cv::Mat drawOverlay(
    const cv::Mat& gray, const cv::Mat& depth, const FrameRecord& record, std::size_t frameIndex);

/** Writes one picture per frame: <folder>/000042.png. */
class OverlaySink : public Sink
{
 public:
    /** \throws EnvironmentError if the folder cannot be created */
    explicit OverlaySink(const std::string& folder);

    void add(const OutputItem& item) override;
    void close() override {}
    void discard() noexcept override {}  // each picture is complete
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] bool needsFeatures() const override { return true; }

 private:
    std::string folder_;
    std::size_t numPictures_{0};
};
}  // namespace pointplane
