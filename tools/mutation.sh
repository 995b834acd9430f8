#!/usr/bin/env bash
# Breaks one line at a time, in a copy of the tree, and runs the tests that should notice.
# Fails when a mutant survives, or when a line that is to be broken is not there any more.
build_dir=build/mutation/build
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
source tools/instrumented.sh

# file | the line's text | what it becomes | tests
mutants=(
    'libs/pose/src/residuals.cpp|-Eigen::Matrix3d::Identity(), hat(p_prev)|-Eigen::Matrix3d::Identity(), -hat(p_prev)|pose_residuals'
    'libs/pose/src/residuals.cpp|(Eigen::Matrix3d::Identity() + s * u|(Eigen::Matrix3d::Identity() - s * u|pose_residuals'
    'libs/pose/src/residuals.cpp|Identity() - 2 * theta * theta|Identity() - theta * theta|pose_residuals'
    'libs/pose/src/NormalEquations.cpp|noise * g * g * w * w * JtW|noise * g * g * w * JtW|pose_PoseSolver pose_PoseSolverCovariance'
    'libs/pose/src/NormalEquations.cpp|w > 0.5 ? 1 : 0|w > 0.05 ? 1 : 0|pose_PoseSolver'
    'libs/core/src/se3.cpp|a.z(), 0, -a.x(), -a.y(), a.x(), 0|a.z(), 0, -a.y(), -a.x(), a.y(), 0|core_se3'
    'libs/core/src/se3.cpp|topRightCorner<3, 3>() = hat|bottomLeftCorner<3, 3>() = hat|core_se3 core_PoseGaussian'
    'libs/core/src/Plane.cpp|= -n.transpose() / (norm * norm)|= n.transpose() / (norm * norm)|core_Plane'
    'libs/sensor/src/DepthNoise.cpp|topLeftCorner<2, 2>() +=|bottomRightCorner<2, 2>() +=|sensor_DepthNoise'
    'libs/sensor/src/DepthNoiseLearner.cpp|kBeyondCell * std::sqrt(variance.x())|std::sqrt(variance.x())|sensor_DepthNoiseLearner'
    'libs/planes/src/PlaneClustering.cpp|return part * part|return part|planes_PlaneClustering'
    'libs/sensor/src/PinholeCamera.cpp|6 * k[3] * x|2 * k[3] * x|sensor_PinholeCamera'
    'libs/planes/src/PlaneFitter.cpp|b -= w * P|b += w * P|planes_PlaneFitter'
    'libs/odometry/src/uncertainty/JointCovariance.cpp|at(n, n) - at(n, k) - at(k, n)|at(n, n) + at(n, k) - at(k, n)|odometry_JointCovariance'
    'libs/odometry/src/uncertainty/JointCovariance.cpp|dt * prior + measurement|prior + measurement|odometry_JointCovariance'
    'libs/pose/src/SolutionAnalysis.cpp|ofUnitNoise += equations_|ofUnitNoise = equations_|pose_Sensitivity'
    'libs/pose/src/PoseSolver.cpp|kStartWidening = 4|kStartWidening = 1|pose_PoseSolver'
    'libs/odometry/src/ShutterCorrection.cpp|(sColour - sDepth) * P|(sDepth - sColour) * P|odometry_ShutterCorrection'
    'libs/points/src/patch_template.cpp|static_cast<short>(g.x - meanX)|static_cast<short>(g.x)|points_lucas_kanade'
    'libs/points/src/Patch.cpp|out -= pixels_|out += pixels_|points_Patch points_patch_uncertainty'
    'libs/points/src/patch_uncertainty.cpp|(-out.axes|(out.axes|points_patch_uncertainty'
    'libs/pose/src/residuals.cpp|dRef_dCamera - R * pair|dRef_dCamera + R * pair|pose_Sensitivity'
    'libs/pose/src/SolutionAnalysis.cpp|1 - 2.0 / 3 * J|1 - 1.0 / 3 * J|pose_Sensitivity'
    'libs/odometry/src/uncertainty/ResidualVariogram.cpp|*far - *step|*far|odometry_ResidualVariogram'
    'libs/pose/src/PoseSolver.cpp|camera.H.transpose() * out|-camera.H.transpose() * out|pose_Sensitivity'
    'libs/odometry/src/uncertainty/view_errors.cpp|-motion.translation().norm() / kDistance|-motion.translation().norm()|odometry_view_errors'
    'libs/odometry/src/uncertainty/JointCovariance.cpp|1 - weights.dot(shared)|1.0|odometry_JointCovariance'
    'libs/points/src/warped_patches.cpp|gain = -ofGradient|gain = ofGradient|points_warped_patches'
    'libs/points/src/local_surface.cpp|0, -camera.fx * p.x()|0, camera.fx * p.x()|points_local_surface'
    'libs/points/src/PointTracker.cpp|T_cur_ref.linear() * surfaceJacobian|surfaceJacobian|points_PointTracker'
    'libs/odometry/src/uncertainty/MotionModel.cpp|next.dt * last.velocity + last.dt|last.dt * last.velocity + next.dt|odometry_MotionModel'
    'libs/planes/src/PlaneMatcher.cpp|dot(plane.n) >= minCosine|dot(plane.n) <= minCosine|planes_PlaneMatcher'
)
readonly tree=build/mutation/tree log=build/mutation/log

install_packages "${build_packages[@]}"
rm -rf "$tree"
mkdir -p "$tree"
# shellcheck disable=SC2046  # no name in this tree has a space
cp -p --parents $(git ls-files CMakeLists.txt cmake libs tests benchmarks) "$tree"
# What an earlier run built last of these files may be a mutant.
for mutant in "${mutants[@]}"; do touch "$tree/${mutant%%|*}"; done

source_dir=$tree
configure_instrumented -DPOINTPLANE_BUILD_APPS=OFF -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1

# passes TEST...: builds and runs; a mutant that does not compile would prove nothing.
passes() {
    local name
    cmake --build "$build_dir" --parallel "$(num_jobs)" --target "${@/#/test_}" >"$log" 2>&1 ||
        die "does not compile, see $log"
    for name in "$@"; do
        timeout 300 "$build_dir/tests/test_$name" >"$log" 2>&1 || return 1
    done
}

say "the tests as they are"
declare -A all_tests=()
for mutant in "${mutants[@]}"; do
    for name in ${mutant##*|}; do all_tests[$name]=1; done
done
passes "${!all_tests[@]}" || die "fails without any mutation, see $log"

say "${#mutants[@]} mutants"
survivors=0
for mutant in "${mutants[@]}"; do
    IFS='|' read -r file old new tests <<<"$mutant"
    original=$(<"$tree/$file")
    mutated=${original/"$old"/"$new"}
    [[ $mutated != "$original" ]] || die "$file has no '$old' any more: change tools/mutation.sh"
    printf '%s\n' "$mutated" >"$tree/$file"
    # shellcheck disable=SC2086  # a list of names
    if passes $tests; then
        verdict=SURVIVED
        survivors=$((survivors + 1))
    else
        verdict=caught
    fi
    printf '%-8s  %-34s %s -> %s\n' "$verdict" "$file" "$old" "$new"
    printf '%s\n' "$original" >"$tree/$file"
done
printf '%d of %d mutants caught\n' "$((${#mutants[@]} - survivors))" "${#mutants[@]}"
exit $((survivors > 0))
