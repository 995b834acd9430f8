// SPDX-License-Identifier: BSD-3-Clause
#include "robust_cost.h"

#include <cmath>

#include <gtest/gtest.h>

using namespace pointplane;

namespace
{
template <class Estimator>
void expectWeightIsDerivativeOfCost(const Estimator& estimator, double squaredNorm)
{
    const double h = 1e-4;
    const double derivative =
        (estimator(squaredNorm + h).cost - estimator(squaredNorm - h).cost) / (2 * h);
    EXPECT_NEAR(estimator(squaredNorm).weight, derivative, 1e-8) << "at " << squaredNorm;
}
}  // namespace

TEST(RobustCost, weightsAreTheDerivativesOfTheCosts)
{
    for (const double squaredNorm : {0.5, 3.0, 8.0, 20.0, 100.0})
    {
        expectWeightIsDerivativeOfCost([](double s) { return tukey(s, 4); }, squaredNorm);
        expectWeightIsDerivativeOfCost([](double s) { return student(s, 5); }, squaredNorm);
    }
}

TEST(RobustCost, tukeyByHand)
{
    // A limit of 2 and a squared norm of 1: u = 1/4.
    EXPECT_DOUBLE_EQ(tukey(1, 2).weight, 9.0 / 16);
    EXPECT_DOUBLE_EQ(tukey(1, 2).cost, 4.0 / 3 * (1 - 27.0 / 64));
    EXPECT_DOUBLE_EQ(tukey(0, 2).weight, 1);
    EXPECT_DOUBLE_EQ(tukey(0, 2).cost, 0);
}

TEST(RobustCost, tukeyIgnoresWhatIsBeyondTheLimit)
{
    EXPECT_EQ(tukey(4, 2).weight, 0);
    EXPECT_EQ(tukey(1e9, 2).weight, 0);
    EXPECT_DOUBLE_EQ(tukey(1e9, 2).cost, 4.0 / 3);
}

TEST(RobustCost, studentByHand)
{
    // Five degrees of freedom: a residual of three squared sigmas, as expected, has the weight 1.
    EXPECT_DOUBLE_EQ(student(3, 5).weight, 1);
    EXPECT_DOUBLE_EQ(student(5, 5).cost, 8 * std::log(2.0));
    EXPECT_DOUBLE_EQ(student(0, 5).cost, 0);
}
