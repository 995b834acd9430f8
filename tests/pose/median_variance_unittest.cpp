// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/pose/median_variance.h>

#include <utility>
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

/** Of vectors of one, two and three dimensions together. */
TEST(medianVariance, isThatOfTheRightOnes)
{
    test::GaussianSampler sampler(1);
    std::vector<double> norms;
    for (int i = 0; i < 20000; ++i)
    {
        norms.push_back(4 * sampler.vector<3>().squaredNorm() / medianChi2(3));
        norms.push_back(4 * sampler.vector<2>().squaredNorm() / medianChi2(2));
        norms.push_back(4 * sampler.vector<1>().squaredNorm() / medianChi2(1));
    }
    EXPECT_NEAR(medianVariance(norms), 4, 0.1);
    norms.insert(norms.end(), 800, 1e9);
    EXPECT_NEAR(medianVariance(norms), 4, 0.2);
}

/** References often share two planes only. */
TEST(medianVariance, ofAnEvenNumberIsTheMeanOfTheMiddleTwo)
{
    std::vector<double> two{7, 1}, four{100, 3, 1, 2};
    EXPECT_EQ(medianVariance(two), 4);
    EXPECT_EQ(medianVariance(four), 2.5);
    std::vector<std::pair<double, double>> weighted{{7, 3}, {1, 2}, {2, 1}};
    EXPECT_EQ(medianVariance(weighted), 4.5) << "half of the weight is on 1 and 2, half on 7";
}

TEST(medianVariance, halfOfTheWeightIsOnNormsUpToIt)
{
    std::vector<std::pair<double, double>> norms{{300, 1}, {1, 6}, {100, 1}, {2, 6}, {200, 1}};
    std::vector<double> alike{300, 1, 100, 2, 200};
    EXPECT_EQ(medianVariance(alike), 100);
    EXPECT_EQ(medianVariance(norms), 2) << "6 of 15 are on 1, 12 on up to 2";
    norms.clear();
    EXPECT_EQ(medianVariance(norms), 0);
}
}  // namespace pointplane
