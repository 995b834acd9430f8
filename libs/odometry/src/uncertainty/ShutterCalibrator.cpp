// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/range.h>
#include <pointplane/odometry/uncertainty/ShutterCalibrator.h>
#include <pointplane/pose/residuals.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr double kStep = 1e-3;     //!< of the numeric derivative [s]
constexpr double kMaxTime = 0.05;  //!< no camera is slower [s]
constexpr double kStudentDof = 3;  //!< residuals have outliers

using Matrix123d = Eigen::Matrix<double, 12, 3>;

/** Normal equations of motion and shutter. */
struct JointNormal
{
    Matrix12d Hxx;
    Matrix123d Hxs{Matrix123d::Zero()};
    Eigen::Matrix3d Hss{Eigen::Matrix3d::Zero()};
    Vector12d gx;
    Eigen::Vector3d gs{Eigen::Vector3d::Zero()};

    JointNormal(const MotionPrior& prior, const Motion& motion)
        : Hxx(prior.velocityGivenPose), gx(-prior.velocityGivenPose * prior.residual(motion))
    {
        Hxx.diagonal().array() += 1e-3;
    }

    void add(const Residual& residual, const Eigen::Matrix3d& Js, double factor)
    {
        const Eigen::Matrix3d cov_inverse = residual.cov.inverse() / factor;
        const double norm2 = residual.r.dot(cov_inverse * residual.r);
        const Eigen::Matrix3d W = (kStudentDof + 3) / (kStudentDof + norm2) * cov_inverse;
        Eigen::Matrix<double, 3, 12> Jx;
        Jx << residual.J, residual.J_V;
        const Matrix123d JxtW = Jx.transpose() * W;
        Hxx += JxtW.lazyProduct(Jx);  // a general matrix product would pack its operands
        Hxs += JxtW * Js;
        Hss += Js.transpose() * W * Js;
        gx += JxtW * residual.r;
        gs += Js.transpose() * W * residual.r;
    }
};
}  // namespace

void ShutterCalibrator::TParams::check() const
{
    checkRange("readoutColour", readoutColour, -kMaxTime, kMaxTime);
    checkRange("readoutDepth", readoutDepth, -kMaxTime, kMaxTime);
    checkRange("depthDelay", depthDelay, -kMaxTime, kMaxTime);
    checkRange("sigmaPrior", sigmaPrior, 1e-5, 1);
    checkRange("varianceFactor", varianceFactor, 0.01, 1000);
}

ShutterCalibrator::ShutterCalibrator(const TParams& params)
    : params_(params), estimate_(params.readoutColour, params.readoutDepth, params.depthDelay)
{
    params_.check();
    information_ = Eigen::Matrix3d::Identity() / (params_.sigmaPrior * params_.sigmaPrior);
    informationVector_ = information_ * estimate_;
}

ShutterModel ShutterCalibrator::complete(const ShutterModel& source) const
{
    if (!params_.correct)
    {
        return {0, 0, 0};
    }
    const auto known = [](double a, double b) { return std::isfinite(a) ? a : b; };
    // Who knows the readouts knows when images are exposed. Otherwise the delay comes from time
    // stamps, which tell when they arrived.
    const bool tellsExposure = std::isfinite(source.readoutColour) &&
                               std::isfinite(source.readoutDepth) &&
                               std::isfinite(source.depthDelay);
    return {
        known(source.readoutColour, estimate_[0]),
        known(source.readoutDepth, estimate_[1]),
        known(source.depthDelay, 0) + (tellsExposure ? 0 : estimate_[2])};
}

Matrix6d ShutterCalibrator::update(
    const PairBuilder& builder,
    const std::vector<Association>& associations,
    const Motion& motion,
    const MotionPrior& prior,
    const NoiseFactors& noise)
{
    if (!params_.correct || !params_.selfCalibrate)
    {
        return Matrix6d::Zero();
    }
    // Residuals now, and with each of the three values a little larger. Readout times that the
    // source tells do not change with the estimate, and so take no part.
    std::vector<PointPair> points[4];
    std::vector<PlanePair> planes[4];
    for (int k = 0; k < 4; ++k)
    {
        ShutterCalibrator shifted = *this;
        if (k > 0)
        {
            shifted.estimate_[k - 1] += kStep;
        }
        builder.build(associations, shifted, points[k], planes[k]);
    }
    JointNormal normal(prior, motion);
    Eigen::Matrix3d Js;
    for (size_t i = 0; i < points[0].size(); ++i)
    {
        const Residual residual = pointResidual(points[0][i], motion);
        for (int k = 0; k < 3; ++k)
        {
            Js.col(k) = (pointResidual(points[k + 1][i], motion).r - residual.r) / kStep;
        }
        normal.add(residual, Js, noise.points);
    }
    for (size_t i = 0; i < planes[0].size(); ++i)
    {
        const Residual residual = planeResidualMinimal(planes[0][i], motion);
        for (int k = 0; k < 3; ++k)
        {
            Js.col(k) = (planeResidualMinimal(planes[k + 1][i], motion).r - residual.r) / kStep;
        }
        normal.add(residual, Js, noise.planes);
    }
    const Matrix123d eliminated = normal.Hxx.ldlt().solve(normal.Hxs);
    // Frames repeat each other's residuals: each counts as a fraction of one.
    const Eigen::Matrix3d information =
        (normal.Hss - normal.Hxs.transpose() * eliminated) / params_.varianceFactor;
    const Eigen::Vector3d gradient =
        (normal.gs - eliminated.transpose() * normal.gx) / params_.varianceFactor;
    information_ += information;
    informationVector_ += information * estimate_ - gradient;
    estimate_ =
        information_.ldlt().solve(informationVector_).cwiseMax(-kMaxTime).cwiseMin(kMaxTime);
    // "Consider" covariance (Schmidt 1966): d pose / d shutter = -Hxx^-1 Hxs.
    const Eigen::Matrix<double, 6, 3> K = eliminated.topRows<6>();
    return propagate(K, information_.inverse().eval());
}
}  // namespace pointplane
