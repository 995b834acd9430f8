// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/QR>

#include <map>

#include "SolutionAnalysis.h"

namespace pointplane
{
namespace
{
/** The columns of the normal equations that belong to errors of the camera. */
struct Columns
{
    MotionByCamera H{MotionByCamera::Zero()};  //!< with pose and velocity
    CameraInformation own;                     //!< with each other, motion not eliminated
    CameraByVelocity byVelocity{CameraByVelocity::Zero()};  //!< of own.gradient, of a reference

    Columns& operator+=(const Columns& other)
    {
        H += other.H;
        own.information += other.own.information;
        own.gradient += other.own.gradient;
        byVelocity += other.byVelocity;
        return *this;
    }
};

/** Those of one residual. */
Columns columnsOf(const NormalEquations& equations, size_t i)
{
    Columns out;
    const double w = equations.weight(i);
    if (w > 0)
    {
        const Residual& residual = equations.residual(i);
        const ByCamera& K = residual.ofCamera;
        const ByCamera weighted = equations.gain(i) * w * equations.weightMatrix(i) * K;
        out.H << residual.J.transpose() * weighted, residual.J_V.transpose() * weighted;
        out.own.information = K.transpose().lazyProduct(weighted);
        out.own.gradient = weighted.transpose() * residual.r;
        out.byVelocity = weighted.transpose() * residual.ofReferenceVelocity;
    }
    return out;
}

/** What one reference says of the camera, with a motion of its own. */
CameraInformation withoutMotion(const Solution& at, int reference, const Columns& columns)
{
    Matrix6d H = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    for (const Solution::References* references : {&at.points, &at.planes})
    {
        if (const auto sum = references->find(reference); sum != references->end())
        {
            H += sum->second.H.topLeftCorner<6, 6>();
            gradient += sum->second.g.head<6>();
        }
    }
    // Of some directions, a reference may tell nothing.
    const Eigen::Matrix<double, 6, kNumCameraErrors> ofCamera = columns.H.topRows<6>();
    const Eigen::Matrix<double, 6, kNumCameraErrors> follows =
        H.completeOrthogonalDecomposition().solve(ofCamera);
    CameraInformation out = columns.own;
    out.information -= ofCamera.transpose() * follows;
    out.gradient -= follows.transpose() * gradient;
    return out;
}
}  // namespace

void addCamera(const Solution& at, PoseAnalysis& out)
{
    Columns all;
    std::map<int, Columns> byReference;
    const auto add = [&](const auto& pairs, size_t offset)
    {
        for (size_t i = 0; i < pairs.size(); ++i)
        {
            const Columns columns = columnsOf(at.equations, offset + i);
            all += columns;
            byReference[pairs[i].reference] += columns;
        }
    };
    add(at.problem.points, 0);
    add(at.problem.planes, at.problem.points.size());

    out.sensitivity.camera = -at.H_inverse * all.H;
    out.camera = all.own;  // at the solution, the gradient of the motion is zero
    out.camera.information += all.H.transpose() * out.sensitivity.camera;
    for (const auto& [reference, columns] : byReference)
    {
        out.cameraByVelocity[reference] =
            columns.byVelocity +
            all.H.transpose() * out.sensitivity.references.at(reference).rightCols<6>();
        const CameraInformation alone = withoutMotion(at, reference, columns);
        const auto numReferences = static_cast<double>(byReference.size());
        out.cameraByReference.information += alone.information / numReferences;
        out.cameraByReference.gradient += alone.gradient / numReferences;
    }
}
}  // namespace pointplane
