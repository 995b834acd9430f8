// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>
#include <pointplane/odometry/MovingRegions.h>
#include <pointplane/planes/PlaneFeature.h>
#include <pointplane/points/PointFeature.h>
#include <pointplane/sensor/DepthNoise.h>

#include <string>
#include <vector>

namespace pointplane
{
enum class TrackingStatus
{
    First,      //!< start of a trajectory: the pose is the identity with a negligible covariance
    Tracked,    //!< measured; directions that it does not tell are predicted, and so uncertain
    Predicted,  //!< not measurable from this frame: motion model only
    Lost        //!< the frame could not be used at all: motion model only
};

/** "first", "tracked", "predicted" or "lost". */
[[nodiscard]] const char* toString(TrackingStatus status);

/** Whether the frame shows where it is: not predicted, and not lost. */
[[nodiscard]] inline bool isMeasured(TrackingStatus status)
{
    return status == TrackingStatus::First || status == TrackingStatus::Tracked;
}

/** What the camera's motion has told of a lens that nobody calibrated, or wrongly. */
struct LearntLens
{
    /** What the true calibration has more than the given one: principal point x, y [px], focal
     * length [relative], radial distortion k1. */
    Eigen::Vector4d errors{0, 0, 0, 0};
    Eigen::Vector4d sigmas{0, 0, 0, 0};  //!< their standard deviations; 0: not learnt
    bool isContradicted{false};          //!< a calibration was given, but the images do not fit it
};

/** One line for users; empty if nothing is learnt. */
[[nodiscard]] std::string describe(const LearntLens& lens);

/** What happened inside one frame. */
struct FrameDiagnostics
{
    int numPoints{0};               //!< points found again, or new ones with depth, each once
    int numPlanes{0};               //!< planes extracted
    int numPointPairs{0};           //!< matched to a reference
    int numPlanePairs{0};           //!< matched to a reference
    int numPointInliers{0};         //!< pairs with a Tukey weight above 1/2
    int numPointsDoubted{0};        //!< points found again that count for less than half, each once
    int numPointsRejected{0};       //!< points found again that do not count, each once
    int numReferences{0};           //!< frames that this one was aligned with
    int iterations{0};              //!< of the pose solver
    int observableDirections{0};    //!< of 6, measured better than the motion model predicts
    double pointChi2PerDof{0};      //!< reduced chi-square of point residuals
    double planeChi2PerDof{0};      //!< reduced chi-square of plane residuals
    double surfaceAgreement{0};     //!< fraction of surfaces in view that depth shows
    double movingShare{0};          //!< fraction of them that an earlier frame saw through
    double attachedShare{0};        //!< of the view that moves with the camera (AttachedParts)
    double maxSigmaTranslation{0};  //!< largest standard deviation of the increment [m]
    double maxSigmaRotation{0};     //!< [rad]
    DepthNoise depthNoise;          //!< of the camera, as learnt so far
    LearntLens lens;                //!< likewise
    double msPoints{0}, msPlanes{0}, msMatching{0}, msPose{0}, msTotal{0};  //!< wall time [ms]
};

/** The result of one frame. Poses are of the camera's optical frame. Their covariances are of left
 * perturbations, and strictly positive definite. */
struct OdometryResult
{
    TrackingStatus status{TrackingStatus::Lost};
    std::string reason;      //!< why not tracked, or what it lacks; or empty. No full stop
    double stamp{0};         //!< of the frame [s]
    PoseGaussian increment;  //!< T_before_cur since the frame before, measured or not
    PoseGaussian pose;       //!< T_world_cur; the world is the first usable frame
    /** T_past_cur since 1, 2, ... frames ago, whatever their status, back to
     * OdometryParams::covariance.history frames or the first one. Composed increments have the same
     * mean but too large a covariance: frames that were compared with the same references err
     * together. */
    std::vector<PoseGaussian> since;
    FrameDiagnostics diagnostics;
};

/** What became of a point or plane of a frame. */
enum class FeatureUse
{
    Used,      //!< found again, and the pose follows it: its robust weight times the share of
               //!< its surface is above 1/2, of a plane over that of the best plane
    Doubted,   //!< found again, but it counts for little or nothing
    Rejected,  //!< found again, but it contradicts the others, or the frame was not tracked
    New        //!< not compared with an earlier frame
};

/** What was found in the latest frame, for pictures and reports. */
struct FrameFeatures
{
    struct Point
    {
        Eigen::Vector2d uv_px{0, 0};
        FeatureUse use{FeatureUse::New};
    };
    std::vector<Point> points;  //!< each once, however many references it was compared with
    PlaneSet planes;
    std::vector<FeatureUse> planeUses;  //!< of planes.planes
    MovingRegions moving;               //!< what has come to where it was not before
    bool isKeyframe{false};             //!< later frames are compared with this one
};
}  // namespace pointplane
