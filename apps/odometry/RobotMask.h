// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <string>

#include "FrameSource.h"

namespace pointplane
{
/** The mask of the robot (--mask), and whether it suits the recording. */
class RobotMask
{
 public:
    /** \param path empty: there is none \throws InputError as readMask() */
    explicit RobotMask(const std::string& path);

    [[nodiscard]] const cv::Mat& image() const { return image_; }

    /** By the first frame that has images; of those after it, the odometry says what is wrong.
     * \throws InputError if the mask is of another size */
    void requireFit(const SourceItem& item);

    /** What to add to the reason if a frame has enough depth, but not beside the robot. */
    [[nodiscard]] std::string effectOn(RgbdFrame frame) const;

 private:
    std::string path_;
    cv::Mat image_;   //!< as readMask() reads it
    bool isChecked_;  //!< whether it is of the images' size
};
}  // namespace pointplane
