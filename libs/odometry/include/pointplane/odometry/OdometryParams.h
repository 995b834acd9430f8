// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/odometry/MotionModel.h>
#include <pointplane/planes/PlaneExtractor.h>
#include <pointplane/planes/PlaneMatcher.h>
#include <pointplane/pose/PoseSolver.h>
#include <pointplane/sensor/DepthNoise.h>

#include <limits>
#include <string>

namespace pointplane
{
/** Fallback for what a source does not know of its shutter (sensor/RgbdFrame.h). */
struct ShutterParams
{
    double readoutColour{0};
    double readoutDepth{0};
    double depthDelay{0};

    template <class V>
    void visit(V&& v)
    {
        v("readoutColour", readoutColour, "s", "first to last row of the colour image, when unknown");
        v("readoutDepth", readoutDepth, "s", "first to last row of the depth image, when unknown");
        v("depthDelay", depthDelay, "s", "depth exposure after colour's, when unknown");
    }
    void check() const;
};

/** Which frames the current one is aligned with, and when to make a key frame. */
struct ReferenceParams
{
    std::string reference{"keyframes"};
    int maxKeyframes{4};
    double keyframeDistance{0.15};
    double keyframeAngleDeg{10.0};
    double keyframeMinOverlap{0.5};

    template <class V>
    void visit(V&& v)
    {
        v("reference", reference, "-", "keyframes (key frames and the previous frame) or previous");
        v("maxKeyframes", maxKeyframes, "-", "that are kept, the oldest is dropped");
        v("keyframeDistance", keyframeDistance, "m", "new key frame after this translation");
        v("keyframeAngleDeg", keyframeAngleDeg, "deg", "or this rotation");
        v("keyframeMinOverlap", keyframeMinOverlap, "-", "or when fewer features than this are found again");
    }
    void check() const;
};

/** All parameters of the odometry, one ini section a group. */
struct OdometryParams
{
    DepthNoise depthNoise;
    ShutterParams shutter;
    PlaneExtractor::TParams planeExtractor;
    PlaneMatcher::TParams planeMatcher;
    PoseSolver::TParams poseSolver;
    MotionModel::TParams motionModel;
    ReferenceParams reference;

    /** Calls f(sectionName, group) for each group. */
    template <class F>
    void visitSections(F&& f)
    {
        f("DepthNoise", depthNoise);
        f("Shutter", shutter);
        f("PlaneExtractor", planeExtractor);
        f("PlaneMatcher", planeMatcher);
        f("PoseSolver", poseSolver);
        f("MotionModel", motionModel);
        f("Reference", reference);
    }

    /** \throws std::invalid_argument naming section and key */
    void check() const;
};
}  // namespace pointplane
