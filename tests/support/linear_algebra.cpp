// SPDX-License-Identifier: BSD-3-Clause
#include "linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace pointplane::test
{
SymmetricEigen symmetricEigen(const Eigen::MatrixXd& S)
{
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> es(S);
    return {es.eigenvalues(), es.eigenvectors()};
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& A) { return A.inverse(); }

double squaredMahalanobis(const Eigen::VectorXd& e, const Eigen::MatrixXd& C)
{
    return e.dot(C.ldlt().solve(e));
}

bool hasCholesky(const Eigen::MatrixXd& S) { return S.llt().info() == Eigen::Success; }
}  // namespace pointplane::test
