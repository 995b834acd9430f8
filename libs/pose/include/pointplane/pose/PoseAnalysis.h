// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/pose/InlierRatio.h>
#include <pointplane/pose/pairs.h>

#include <map>
#include <vector>

namespace pointplane
{
/** How much the reference frames contradict each other: how far the features of each draw the pose
 * away from where all together put it. */
struct Disagreement
{
    double observed{0};  //!< squared distance, in units of the covariances
    double expected{0};  //!< if errors are as claimed and independent; 0 = nothing to compare
};

/** How an estimate of pose (left perturbation, in the previous frame) and velocity changes with
 * what it was made from, to first order. Rows: [translation; rotation; velocity], in m, rad, m/s,
 * rad/s. */
struct Sensitivity
{
    /** Change with the pose of each reference frame (left perturbation in the previous frame) and
     * with its body velocity, by which its features were moved (rolling shutter). */
    std::map<int, Matrix12d> references;
    /** The part of that by points, for the references that have some. */
    std::map<int, Matrix12d> referencePoints;
    /** Change if all points, or all planes, of the current frame moved (left perturbation in the
     * previous frame). */
    Matrix126d pointsMoved{Matrix126d::Zero()}, planesMoved{Matrix126d::Zero()};
    /** Change with the prior's mean, in the order of MotionPrior::residual(). */
    Matrix12d prior{Matrix12d::Zero()};
    /** Covariance by the noise of the current frame's points and planes, as propagated: without the
     * noise factors and without the errors of the references. */
    Matrix12d points{Matrix12d::Zero()}, planes{Matrix12d::Zero()};
    /** Change with errors of the camera, which all features share. */
    MotionByCamera camera{MotionByCamera::Zero()};
    /** Change with the scale of depth in each patch of the current image and of the references. */
    MotionByPatches patches{MotionByPatches::Zero()};
    std::map<int, MotionByPatches> referencePatches;
};

/** What the residuals say of the camera's errors, once pose and velocity have been eliminated
 * (Schur complement): half of the cost has the slope gradient + information * error. */
struct CameraInformation
{
    CameraMatrix information{CameraMatrix::Zero()};
    CameraVector gradient{CameraVector::Zero()};  //!< of half of the cost
};

/** How large residuals against one reference are. */
struct ReferenceVariance
{
    int reference;
    double variance;
    double dof;  //!< how much it counts: dimensions without what poses follow; patches
};

/** How large the residuals of planes are. */
struct PlaneResiduals
{
    std::vector<ReferenceVariance> references;  //!< that tell; over the propagated variance
    /** What planes tell of the direction that they tell least, of what all features do; 1: nothing
     * else tells of the pose. */
    double followed{1};
};

/** What a solution tells besides the motion. */
struct PoseAnalysis
{
    Sensitivity sensitivity;
    CameraInformation camera;
    /** The same by each reference with a motion of its own, averaged over the references: poses of
     * references that were estimated with a wrong camera would confirm it. */
    CameraInformation cameraByReference;
    /** Of the residuals of points that count, over the propagated one; 0 = none. */
    double pointVariance{0};
    double planeVariance{0};  //!< the same of all planes
    PlaneResiduals planeResiduals;
    /** Of the scale of depth in a patch of an image, as the points' residuals show it. */
    std::vector<ReferenceVariance> patchResiduals;
    Disagreement pointDisagreement;  //!< of the references' points, with all other features
    Disagreement planeDisagreement;  //!< of their planes, likewise
    /** Of a turn about an axis, as points tell it: harmonic mean over axes, by the propagated noise
     * alone [rad^2]; 0 = no points. */
    double turnVariance{0};
    /** How far the parts of the image pull the pose apart: mean square of their pulls, over what
     * the propagated noise explains; 0 = too few parts to compare. A part is a cell of the view
     * with its points, or a plane. Where noise is all, it is the variance of the residuals. It is
     * larger where neighbours err together, as by blur, by a shutter in jerky motion, or by bent
     * depth (Liang and Zeger 1986, the variance of clustered data). */
    double scatter{0};
    std::vector<double> pointWeights, planeWeights;  //!< of the pairs: 1 = counts fully
    std::vector<InlierRatio> surfaces;  //!< PoseProblem::surfaces, with this frame's points
};
}  // namespace pointplane
