// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace pointplane::test
{
/** Eigen's solvers for matrices of any size, compiled once: each test that has its own takes
 * seconds longer to compile. */
struct SymmetricEigen
{
    Eigen::VectorXd values;   //!< ascending
    Eigen::MatrixXd vectors;  //!< in columns
};
[[nodiscard]] SymmetricEigen symmetricEigen(const Eigen::MatrixXd& S);

[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);

/** e^T C^-1 e. \param C symmetric, positive definite */
[[nodiscard]] double squaredMahalanobis(const Eigen::VectorXd& e, const Eigen::MatrixXd& C);

/** True when Cholesky's factorisation of S exists. */
[[nodiscard]] bool hasCholesky(const Eigen::MatrixXd& S);
}  // namespace pointplane::test
