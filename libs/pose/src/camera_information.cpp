// SPDX-License-Identifier: BSD-3-Clause
#include "camera_information.h"

#include <Eigen/QR>

#include <map>

namespace pointplane
{
namespace
{
/** What one reference says of the camera, with a motion of its own. */
CameraInformation withoutMotion(
    const Solution& at, int reference, const NormalEquations::CameraColumns& columns)
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
    NormalEquations::CameraColumns all;
    std::map<int, NormalEquations::CameraColumns> byReference;
    const auto add = [&](const auto& pairs, size_t offset)
    {
        for (size_t i = 0; i < pairs.size(); ++i)
        {
            const NormalEquations::CameraColumns columns = at.equations.cameraColumns(offset + i);
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
        const CameraInformation alone = withoutMotion(at, reference, columns);
        const auto numReferences = static_cast<double>(byReference.size());
        out.cameraByReference.information += alone.information / numReferences;
        out.cameraByReference.gradient += alone.gradient / numReferences;
    }
}
}  // namespace pointplane
