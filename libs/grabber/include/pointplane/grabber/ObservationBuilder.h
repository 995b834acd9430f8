// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/CameraImage.h>
#include <pointplane/grabber/RgbdCalibration.h>

#include <mrpt/obs/CObservation3DRangeScan.h>

namespace pointplane
{
/** The colour image as CV_8UC3 BGR or CV_8UC1. */
[[nodiscard]] cv::Mat toBgr(const CameraImage& colour);

/** Turns image pairs into observations: depth in the sensor's own counts (rangeUnits), colour BGR,
 * no point cloud. Thread-safe. */
class ObservationBuilder
{
 public:
    explicit ObservationBuilder(RgbdCalibration calibration) : calibration_(std::move(calibration))
    {
    }

    /** Fills an observation of this or a derived class. */
    void fill(const ImagePair& pair, mrpt::obs::CObservation3DRangeScan& observation) const;

    [[nodiscard]] const RgbdCalibration& calibration() const { return calibration_; }

 private:
    RgbdCalibration calibration_;
};
}  // namespace pointplane
