// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/RawlogWriter.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <opencv2/core/mat.hpp>

#include <string>

namespace pointplane
{
/** Writes registered frames to a rawlog as CObservation3DRangeScan: colour, 16 bit depth along the
 * optical axis in units of 1/5000 m, sensorPose the identity. */
class ScanWriter
{
 public:
    static constexpr double kUnitsPerMetre = 5000;

    /** \param external images as files in `<path without extension>_Images`
     * \throws EnvironmentError */
    ScanWriter(const std::string& path, std::string label, bool external);

    void writeComment(double stamp, const std::string& text);
    /** \param colour CV_8UC3 BGR, of the frame's size. \throws EnvironmentError */
    void write(const RgbdFrame& frame, const cv::Mat& colour);
    void close() { writer_.close(); }

 private:
    RawlogWriter writer_;
    std::string label_;
    std::string imagesDirectory_;  //!< empty: embedded
};
}  // namespace pointplane
