// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "FrameGroups.h"
#include "FrameRecord.h"

namespace pointplane
{
/** What a run amounted to. */
struct RunSummary
{
    std::string label;
    std::size_t numFrames{0}, numTracked{0}, numPredicted{0}, numLost{0};
    UntrackedFrames untracked;
    FramesInPart inPart;
    std::size_t firstAttached{0};  //!< frame in which a part of the robot was seen
    double attachedShare{0};       //!< the largest part of the view that it took; 0: none
    std::optional<std::size_t> firstContradicted;  //!< frame that did not fit the intrinsics
    bool hasMotion{false};                         //!< one at least was measured
    double pathLength{0};                          //!< of the robot [m]
    double seconds{0};                 //!< wall time, without that of frames that were skipped
    FrameDiagnostics sum;              //!< of the times per stage; the latest noise and lens
    std::vector<double> stamps;        //!< of the frames that have one [s]
    std::vector<std::string> notes;    //!< lines about the input
    std::string damage;                //!< where the input ended early, or empty
    std::vector<std::string> outputs;  //!< descriptions
    /** The largest standard deviations of the lens: before anything was learnt. */
    Eigen::Vector4d lensPrior{0, 0, 0, 0};

    void add(const OutputItem& item);

    /** \param profile also the mean times per stage */
    void print(std::ostream& out, bool profile) const;

    /** What the exit code is about, in one line each; nothing when it is 0. */
    void printProblems(std::ostream& err) const;

    /** One of mrpt_io/errors.h. */
    [[nodiscard]] int exitCode() const;

 private:
    [[nodiscard]] double perFrame(double total) const;
    void printFrames(std::ostream& out) const;
    void printAttached(std::ostream& out) const;
    void printCalibration(std::ostream& out) const;
    void printStamps(std::ostream& out) const;
    void printLearnt(std::ostream& out) const;  //!< of the camera
    void printTimes(std::ostream& out) const;
    [[nodiscard]] bool isMostlyUnmeasured() const;
    [[nodiscard]] LearntLens learntLens() const;
};
}  // namespace pointplane
