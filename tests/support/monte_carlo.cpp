// SPDX-License-Identifier: BSD-3-Clause
#include "monte_carlo.h"

#include <Eigen/Cholesky>

#include "linear_algebra.h"

namespace pointplane::test
{
Eigen::MatrixXd squareRoot(const Eigen::MatrixXd& cov)
{
    const SymmetricEigen es = symmetricEigen(cov);
    return es.vectors * es.values.cwiseMax(0).cwiseSqrt().asDiagonal();
}

Eigen::MatrixXd GaussianSampler::covariance(int n, double low, double high)
{
    Eigen::MatrixXd A(n, n);
    for (int i = 0; i < n * n; ++i)
    {
        A.data()[i] = normal();
    }
    const Eigen::MatrixXd axes = symmetricEigen(A + A.transpose()).vectors;
    Eigen::VectorXd lambda(n);
    for (int i = 0; i < n; ++i)
    {
        lambda[i] = uniform(low, high);
    }
    return axes * lambda.asDiagonal() * axes.transpose();
}

double whitenedDifference(const Eigen::MatrixXd& sampled, const Eigen::MatrixXd& expected)
{
    const Eigen::LLT<Eigen::MatrixXd> llt(expected);
    const Eigen::MatrixXd half = llt.matrixL().solve(sampled);
    const Eigen::MatrixXd white = llt.matrixL().solve(half.transpose());
    return (white - Eigen::MatrixXd::Identity(white.rows(), white.cols())).norm();
}
}  // namespace pointplane::test
