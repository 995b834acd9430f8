// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/pose/PoseAnalysis.h>
#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
/** Learns the shutter of a camera that nobody has calibrated, from its own motion.
 *
 * The residuals at the estimated pose depend on the readout times and on the delay of the depth
 * image, the more the faster the camera moves. What they say of these times, once the motion is
 * eliminated (CameraInformation), is summed over frames. */
class ShutterCalibrator
{
 public:
    struct TParams
    {
        bool correct{true};
        double readoutColour{0.02};
        double readoutDepth{0.02};
        double depthDelay{0};
        bool selfCalibrate{true};
        double sigmaPrior{0.01};
        double varianceFactor{10.0};

        template <class V>
        void visit(V&& v)
        {
            v("correct",
              correct,
              "-",
              "correct for the camera's motion while it takes an image, row by row; false: all "
              "rows count as taken at once, whatever the recording says (as in the paper)");
            v("readoutColour",
              readoutColour,
              "s",
              "time from the first to the last row of the colour image, if the recording does "
              "not say");
            v("readoutDepth", readoutDepth, "s", "the same of the depth image");
            v("depthDelay",
              depthDelay,
              "s",
              "time from the exposure of colour to that of depth, on top of what the "
              "recording's time stamps say");
            v("selfCalibrate",
              selfCalibrate,
              "-",
              "learn from the camera's motion what the recording does not say");
            v("sigmaPrior",
              sigmaPrior,
              "s",
              "how uncertain the three times above are at first (standard deviation)");
            v("varianceFactor",
              varianceFactor,
              "-",
              "this many frames teach as much as one, also of the lens: neighbouring frames have "
              "the "
              "same errors");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    /** \throws std::invalid_argument naming the key */
    explicit ShutterCalibrator(const TParams& params);

    /** The source's values where it knows them, else the estimate. A delay that comes from time
     * stamps is a part of the true one: the estimate is added. All zero if `correct` is off. */
    [[nodiscard]] ShutterModel complete(const ShutterModel& source) const;

    /** 1 for each of the three times that is estimated, 0 for each that the source knows. */
    [[nodiscard]] Eigen::Vector3d estimated(const ShutterModel& source) const;

    /** How far the times of a source that does not know them may be off [s]. */
    [[nodiscard]] double sigmaPrior() const;

    /** How the error of the estimate changes with a frame: it is gain times the one before, plus
     * noise. */
    struct Change
    {
        Eigen::Matrix3d gain{Eigen::Matrix3d::Identity()};
        Eigen::Matrix3d noise{Eigen::Matrix3d::Zero()};  //!< its covariance [s^2]
    };

    /** Learns from a measured frame.
     * \param variance of its features, over the one by which the solver weighed them */
    Change update(const CameraInformation& camera, double variance = 1);

    /** readoutColour, readoutDepth, depthDelay [s]. */
    [[nodiscard]] const Eigen::Vector3d& estimate() const { return estimate_; }

 private:
    TParams params_;
    Eigen::Vector3d estimate_;
    Eigen::Matrix3d information_;
    Eigen::Vector3d informationVector_;
};
}  // namespace pointplane
