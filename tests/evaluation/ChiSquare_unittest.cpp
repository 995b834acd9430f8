// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/chi_square.h>

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

using namespace pointplane;

TEST(ChiSquare, tabulatedQuantiles)
{
    EXPECT_NEAR(chiSquareQuantile(0.95, 1), 3.841459, 1e-6);
    EXPECT_NEAR(chiSquareQuantile(0.025, 6), 1.237344, 1e-6);
    EXPECT_NEAR(chiSquareQuantile(0.975, 6), 14.449375, 1e-6);
    EXPECT_NEAR(chiSquareQuantile(0.975, 100), 129.561197, 1e-5);
    EXPECT_NEAR(chiSquareQuantile(0.5, 2), 2 * std::log(2.0), 1e-9);  // exponential
}

TEST(ChiSquare, cdfInvertsTheQuantile)
{
    for (const double dof : {1.0, 3.0, 60.0, 999.0})
    {
        for (const double p : {0.001, 0.025, 0.5, 0.975, 0.999})
        {
            EXPECT_NEAR(chiSquareCdf(chiSquareQuantile(p, dof), dof), p, 1e-8) << dof;
        }
    }
}

TEST(ChiSquare, approximationJoinsTheExactValues)
{
    for (const double p : {0.025, 0.975})
    {
        const double exact = chiSquareQuantile(p, 1000);
        EXPECT_NEAR(chiSquareQuantile(p, 1000.0001) / exact, 1, 1e-5);
    }
}

TEST(ChiSquare, refusesBadArguments)
{
    EXPECT_THROW((void)chiSquareQuantile(0, 3), std::invalid_argument);
    EXPECT_THROW((void)chiSquareQuantile(0.5, 0), std::invalid_argument);
    EXPECT_EQ(chiSquareCdf(-1, 3), 0);
}
