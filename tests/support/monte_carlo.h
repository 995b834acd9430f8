// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <random>
#include <vector>

namespace pointplane::test
{
/** Seeded normal samples, the same on every platform's standard library: Box-Muller on mt19937,
 * whose output the standard fixes (std::normal_distribution's is not). */
class GaussianSampler
{
 public:
    explicit GaussianSampler(unsigned seed) : rng_(seed) {}

    /** Uniform in [low, high). */
    double uniform(double low = 0, double high = 1)
    {
        return low + (high - low) * (static_cast<double>(rng_()) / 4294967296.0);
    }

    /** N(0, 1). */
    double normal()
    {
        const double u = 1 - uniform(), v = uniform();
        return std::sqrt(-2 * std::log(u)) * std::cos(2 * 3.14159265358979323846 * v);
    }

    /** N components of N(0, 1). */
    template <int N>
    Eigen::Matrix<double, N, 1> vector()
    {
        Eigen::Matrix<double, N, 1> out;
        for (int i = 0; i < N; ++i)
        {
            out[i] = normal();
        }
        return out;
    }

    /** N(0, cov); cov may be singular. */
    template <class Derived>
    auto sample(const Eigen::MatrixBase<Derived>& cov)
    {
        constexpr int kN = Derived::RowsAtCompileTime;
        const Eigen::SelfAdjointEigenSolver<typename Derived::PlainObject> es(cov.eval());
        const Eigen::Matrix<double, kN, 1> s = es.eigenvalues().cwiseMax(0).cwiseSqrt();
        return (es.eigenvectors() * s.cwiseProduct(vector<kN>())).eval();
    }

    /** A random symmetric positive definite matrix with eigenvalues in [low, high]. */
    template <int N>
    Eigen::Matrix<double, N, N> covariance(double low, double high)
    {
        Eigen::Matrix<double, N, N> A;
        for (int i = 0; i < N * N; ++i)
        {
            A.data()[i] = normal();
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> es(
            (A + A.transpose()).eval());
        Eigen::Matrix<double, N, 1> lambda;
        for (int i = 0; i < N; ++i)
        {
            lambda[i] = uniform(low, high);
        }
        return es.eigenvectors() * lambda.asDiagonal() * es.eigenvectors().transpose();
    }

 private:
    std::mt19937 rng_;
};

/** Second moments of error vectors: E[e e^T], about zero or about their mean. */
template <int N>
[[nodiscard]] Eigen::Matrix<double, N, N> sampleCovariance(
    const std::vector<Eigen::Matrix<double, N, 1>>& errors, bool aboutMean = false)
{
    Eigen::Matrix<double, N, 1> mean = Eigen::Matrix<double, N, 1>::Zero();
    if (aboutMean)
    {
        for (const auto& e : errors)
        {
            mean += e;
        }
        mean /= static_cast<double>(errors.size());
    }
    Eigen::Matrix<double, N, N> out = Eigen::Matrix<double, N, N>::Zero();
    for (const auto& e : errors)
    {
        out += (e - mean) * (e - mean).transpose();
    }
    return out / static_cast<double>(errors.size());
}

/** Frobenius distance of two covariances after whitening by the second: unit-free, sees errors in
 * small directions too. 20 000 samples of a right covariance give about N / 141. */
template <class DerivedA, class DerivedB>
[[nodiscard]] double whitenedDifference(
    const Eigen::MatrixBase<DerivedA>& sampled, const Eigen::MatrixBase<DerivedB>& expected)
{
    using M = typename DerivedA::PlainObject;
    const Eigen::LLT<M> llt(expected.eval());
    const M half = llt.matrixL().solve(sampled);
    const M white = llt.matrixL().solve(half.transpose().eval());
    return (white - M::Identity()).norm();
}
}  // namespace pointplane::test
