// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <random>
#include <vector>

namespace pointplane::test
{
/** R with R R^T = cov; cov may be singular. */
[[nodiscard]] Eigen::MatrixXd squareRoot(const Eigen::MatrixXd& cov);

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
        const Eigen::Matrix<double, kN, kN> root = squareRoot(cov);
        return (root * vector<kN>()).eval();
    }

    /** A random symmetric positive definite matrix with eigenvalues in [low, high]. */
    template <int N>
    Eigen::Matrix<double, N, N> covariance(double low, double high)
    {
        return covariance(N, low, high);
    }

 private:
    Eigen::MatrixXd covariance(int n, double low, double high);

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
[[nodiscard]] double whitenedDifference(
    const Eigen::MatrixXd& sampled, const Eigen::MatrixXd& expected);
}  // namespace pointplane::test
