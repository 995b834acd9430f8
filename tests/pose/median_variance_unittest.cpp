// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/median_variance.h>

#include <vector>

#include "monte_carlo.h"
#include <gtest/gtest.h>

namespace pointplane
{
TEST(medianVariance, ofNoneIsZero)
{
    std::vector<double> none;
    EXPECT_EQ(medianVariance(none), 0);
}

TEST(medianVariance, isThatOfTheRightOnes)
{
    test::GaussianSampler sampler(1);
    std::vector<double> norms;
    for (int i = 0; i < 20000; ++i)
    {
        norms.push_back(4 * sampler.vector<3>().squaredNorm());
    }
    EXPECT_NEAR(medianVariance(norms), 4, 0.1);
    norms.insert(norms.end(), 400, 1e9);
    EXPECT_NEAR(medianVariance(norms), 4, 0.2);
}
}  // namespace pointplane
