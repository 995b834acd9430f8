// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/odometry/PointStage.h>
#include <pointplane/odometry/ReferenceParams.h>
#include <pointplane/odometry/uncertainty/CameraCalibrator.h>
#include <pointplane/odometry/uncertainty/CovarianceParams.h>
#include <pointplane/odometry/uncertainty/MotionParams.h>
#include <pointplane/odometry/uncertainty/NoiseScale.h>
#include <pointplane/planes/PlaneExtractor.h>
#include <pointplane/planes/PlaneMatcher.h>
#include <pointplane/pose/PoseSolver.h>
#include <pointplane/sensor/DepthNoise.h>

#include <string>

namespace pointplane
{
/** The pipeline's own switches. */
struct PipelineParams
{
    bool usePoints{true};
    bool usePlanes{true};
    std::string searchAround{"prediction"};
    std::string degeneracy{"fuse"};
    double gateSigma{0.05};
    double leastAgreement{0.5};
    bool searchImages{true};
    bool findRobot{true};
    double maxGap{1.0};
    int numThreads{1};

    template <class V>
    void visit(V&& v)
    {
        v("usePoints", usePoints, "-", "use points");
        v("usePlanes", usePlanes, "-", "use planes");
        v("searchAround",
          searchAround,
          "-",
          "where a point is searched for: prediction (where the camera's latest motion "
          "would put it) or previous (where it was in the frame before, as in the paper)");
        v("degeneracy",
          degeneracy,
          "-",
          "if a frame does not show the whole motion, like one of a single wall: fuse (predict "
          "the rest) or gate (predict all of it, as in the paper)");
        v("gateSigma",
          gateSigma,
          "m, rad",
          "with degeneracy = gate: a frame is predicted if the standard deviation of its "
          "pose is larger than this in any direction");
        v("leastAgreement",
          leastAgreement,
          "-",
          "fraction of the known surfaces that the depth image must show where the motion puts "
          "them; else the frame is predicted; 0 = no check");
        v("searchImages",
          searchImages,
          "-",
          "if the predicted motion fails, find another one from key points of the whole "
          "image, and recognise known places");
        v("findRobot",
          findRobot,
          "-",
          "leave out what stays the same in view while most of the surface moves: a part of the "
          "robot that carries the camera; --mask does so from the first frame on");
        v("maxGap",
          maxGap,
          "s",
          "after a longer time without a measured frame, the velocity counts as unknown");
        v("numThreads",
          numThreads,
          "-",
          "threads for one frame: 1, or 2 = points and planes side by side; --jobs of the "
          "program is about reading and writing");
    }
    /** \throws std::invalid_argument naming the key */
    void check() const;
    [[nodiscard]] bool fuses() const;          //!< degeneracy is fuse, not gate
    [[nodiscard]] bool searchesAhead() const;  //!< searchAround is prediction, not previous
};

/** All parameters of the odometry, one ini section a group. */
struct OdometryParams
{
    PipelineParams pipeline;
    DepthNoise depthNoise;
    CameraCalibrator::TShutter shutter;
    CameraCalibrator::TLens lens;
    PointStage::TParams points;
    PointTracker::TParams pointTracker;
    PointDetector::TParams pointDetector;
    PointMatcher::TParams pointMatcher;
    PointLifter::TParams pointLifter;
    PlaneExtractor::TParams planeExtractor;
    PlaneMatcher::TParams planeMatcher;
    PoseSolver::TParams poseSolver;
    NoiseScale::TParams noiseScale;
    MotionParams motionModel;
    ReferenceParams reference;
    CovarianceParams covariance;

    /** The first section that only experts need: from here on, keys are about the insides of a
     * stage. */
    static constexpr const char* kFirstExpertSection = "PointTracker";

    /** Calls f(sectionName, group) for each group. */
    template <class F>
    void visitSections(F&& f)
    {
        f("Pipeline", pipeline);
        f("DepthNoise", depthNoise);
        f("Shutter", shutter);
        f("Lens", lens);
        f("Points", points);
        f("Reference", reference);
        f("Covariance", covariance);
        f("PointTracker", pointTracker);
        f("PointDetector", pointDetector);
        f("PointMatcher", pointMatcher);
        f("PointLifter", pointLifter);
        f("PlaneExtractor", planeExtractor);
        f("PlaneMatcher", planeMatcher);
        f("PoseSolver", poseSolver);
        f("NoiseScale", noiseScale);
        f("MotionModel", motionModel);
    }

    /** \throws std::invalid_argument naming section and key */
    void check() const;
};
}  // namespace pointplane
