// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/Random.h>

#include <cmath>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
struct Moments
{
    double mean{0}, variance{0}, kurtosis{0};
};

template <class Draw>
Moments momentsOf(Draw&& draw, int n)
{
    double s1 = 0, s2 = 0, s4 = 0;
    for (int i = 0; i < n; ++i)
    {
        const double x = draw();
        s1 += x;
        s2 += x * x;
        s4 += x * x * x * x;
    }
    return {s1 / n, s2 / n, s4 / n / (s2 / n * s2 / n)};
}
}  // namespace

TEST(Random, gaussianHasTheMomentsItClaims)
{
    Random random({1, 2});
    const Moments m = momentsOf([&] { return random.gaussian(); }, 400000);
    EXPECT_NEAR(m.mean, 0, 0.006);
    EXPECT_NEAR(m.variance, 1, 0.01);
    EXPECT_NEAR(m.kurtosis, 2.85, 0.03);
}

TEST(Random, gaussianPairIsTwoIndependentNormals)
{
    Random random({3});
    double cross = 0, a2 = 0, b2 = 0;
    const int n = 200000;
    for (int i = 0; i < n; ++i)
    {
        float a = 0, b = 0;
        random.gaussianPair(a, b);
        cross += a * b;
        a2 += a * a;
        b2 += b * b;
    }
    EXPECT_NEAR(a2 / n, 1, 0.015);
    EXPECT_NEAR(b2 / n, 1, 0.015);
    EXPECT_NEAR(cross / n, 0, 0.01);
}

TEST(Random, uniformFillsTheInterval)
{
    Random random({4});
    const Moments m = momentsOf([&] { return random.uniform(-1, 1); }, 200000);
    EXPECT_NEAR(m.mean, 0, 0.01);
    EXPECT_NEAR(m.variance, 1.0 / 3, 0.01);
}

TEST(Random, keysDecideTheStreamAndTheirOrderMatters)
{
    EXPECT_EQ(Random({1, 2}).bits(), Random({1, 2}).bits());
    EXPECT_NE(Random({1, 2}).bits(), Random({2, 1}).bits());
    EXPECT_NE(Random({1}).bits(), Random({1, 0}).bits());
}

TEST(Random, neighbouringKeysAreUncorrelated)
{
    double cross = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i)
    {
        const auto k = static_cast<std::uint64_t>(i);
        cross += static_cast<double>(Random({7, k}).gaussian() * Random({7, k + 1}).gaussian());
    }
    EXPECT_NEAR(cross / n, 0, 4 / std::sqrt(n));
}
}  // namespace pointplane
